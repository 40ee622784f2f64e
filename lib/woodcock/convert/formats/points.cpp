// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/formats/points.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "woodcock/base/error.h"
#include "woodcock/base/nearest_name.h"
#include "woodcock/base/printable.h"
#include "woodcock/convert/formats/point_table.h"
#include "woodcock/grid/input_file.h"
#include "woodcock/mesh/ply_file.h"

namespace woodcock::convert {

namespace {

namespace fs = std::filesystem;

enum class Column { X, Y, Z, Radius, Width, Weight, Other };

/// A name without quotes, unit and capitals: "X (m)" is x.
std::string plainName(std::string_view name) {
    std::string plain;
    for (const char c : name)
        plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const auto trim = [&] {
        plain.erase(0, std::min(plain.find_first_not_of(" \t\"'"), plain.size()));
        plain.erase(plain.find_last_not_of(" \t\"'") + 1);
    };
    trim();
    if (plain.size() > 3 && (plain.back() == ')' || plain.back() == ']'))
        if (const std::size_t unit = plain.find_last_of("(["); unit > 0 && plain[0] != 'p') {
            plain.resize(unit);
            trim();
        }
    return plain;
}

Column columnNamed(std::string_view name) {
    constexpr std::pair<std::string_view, Column> known[]{{"x", Column::X},
                                                          {"y", Column::Y},
                                                          {"z", Column::Z},
                                                          {"px", Column::X},
                                                          {"py", Column::Y},
                                                          {"pz", Column::Z},
                                                          {"p[x]", Column::X},
                                                          {"p[y]", Column::Y},
                                                          {"p[z]", Column::Z},
                                                          {"p.x", Column::X},
                                                          {"p.y", Column::Y},
                                                          {"p.z", Column::Z},
                                                          {"points:0", Column::X},
                                                          {"points:1", Column::Y},
                                                          {"points:2", Column::Z},
                                                          {"points_0", Column::X},
                                                          {"points_1", Column::Y},
                                                          {"points_2", Column::Z},
                                                          {"easting", Column::X},
                                                          {"northing", Column::Y},
                                                          {"elevation", Column::Z},
                                                          {"radius", Column::Radius},
                                                          {"pscale", Column::Radius},
                                                          {"width", Column::Width},
                                                          {"density", Column::Weight},
                                                          {"weight", Column::Weight},
                                                          {"value", Column::Weight}};
    const std::string plain = plainName(name);
    for (const auto& [word, column] : known)
        if (word == plain) return column;
    return Column::Other;
}

constexpr const char* columnName(Column column) {
    constexpr const char* names[]{"x", "y", "z", "radius", "width", "density", "not used"};
    return names[static_cast<std::size_t>(column)];
}

struct Columns {
    std::vector<Column> is;
    std::vector<std::string> names;

    void add(std::string_view name, Column column) {
        is.push_back(column);
        names.emplace_back(name.substr(0, 40));
    }
    /// "X is x, 'Intensity' is not used"
    std::string describe() const {
        std::vector<std::string> words;
        constexpr std::size_t most = 12;
        for (std::size_t i = 0; i < is.size() && i < most; ++i) {
            const std::string shown = names[i].empty() ? fmt::format("column {}", i + 1)
                                                       : fmt::format("'{}'", printable(names[i]));
            words.push_back(fmt::format("{} is {}", shown, columnName(is[i])));
        }
        if (is.size() > most) words.push_back(fmt::format("and {} more", is.size() - most));
        return joinNames(words);
    }
    bool has(Column column) const { return std::find(is.begin(), is.end(), column) != is.end(); }
    bool hasPoints() const { return has(Column::X) && has(Column::Y) && has(Column::Z); }
};

/// The next point gets this value of the column.
void append(PointCloud& cloud, Column column, Vec3d& point, double value) {
    switch (column) {
        case Column::X:
            point.x = value;
            break;
        case Column::Y:
            point.y = value;
            break;
        case Column::Z:
            point.z = value;
            break;
        case Column::Radius:
            cloud.radii.push_back(static_cast<float>(value));
            break;
        case Column::Width:
            cloud.radii.push_back(static_cast<float>(value / 2));
            break;
        case Column::Weight:
            cloud.weights.push_back(static_cast<float>(value));
            break;
        case Column::Other:
            break;
    }
}

/// Two columns of one meaning would give a point two radii.
void requireColumns(const fs::path& file, const Columns& columns) {
    const auto count = [&](auto... c) {
        return std::count_if(columns.is.begin(), columns.is.end(),
                             [&](Column column) { return ((column == c) || ...); });
    };
    const auto wrong = [&](const char* what) {
        return inputError("{}: {}; found: {}. Name the columns by --columns, such as x,y,z,radius",
                          file.string(), what, columns.describe());
    };
    if (count(Column::X) != 1 || count(Column::Y) != 1 || count(Column::Z) != 1)
        throw wrong("expected one x, one y and one z of each point");
    if (count(Column::Radius, Column::Width) > 1)
        throw wrong("more than one of radius, pscale and width");
    if (count(Column::Weight) > 1) throw wrong("more than one of density, weight and value");
}

PointCloud readPlyPoints(const fs::path& file) {
    const std::vector<mesh::PlyElement> elements = mesh::readPly(file);
    const auto vertices =
        std::find_if(elements.begin(), elements.end(),
                     [](const mesh::PlyElement& e) { return e.name == "vertex"; });
    if (vertices == elements.end()) throw inputError("{} has no vertices", file.string());
    Columns columns;
    for (const mesh::PlyElement::Property& property : vertices->properties)
        columns.add(property.name, property.isList ? Column::Other : columnNamed(property.name));
    requireColumns(file, columns);
    PointCloud cloud;
    cloud.columns = columns.describe();
    for (std::size_t i = 0; i < vertices->count; ++i) {
        Vec3d point;
        for (std::size_t c = 0; c < columns.is.size(); ++c)
            if (columns.is[c] != Column::Other)
                append(cloud, columns.is[c], point, vertices->properties[c].values[i]);
        cloud.points.push_back(point);
    }
    return cloud;
}

Columns columnsFromWords(const std::string& words) {
    Columns columns;
    std::string_view rest = words;
    for (bool more = true; more;) {
        const std::size_t comma = rest.find(',');
        more = comma != rest.npos;
        const std::string_view name = rest.substr(0, comma);
        rest.remove_prefix(more ? comma + 1 : rest.size());
        const bool skipped = name.empty() || name == "-" || name == "_";
        const Column column = skipped ? Column::Other : columnNamed(name);
        if (!skipped && column == Column::Other)
            throw usageError(
                "--columns: '{}' is not one of x, y, z, radius, pscale, width, density, weight and "
                "value; write - for a column that is not used",
                printable(name));
        columns.add("", column);
    }
    if (!columns.hasPoints())
        throw usageError(
            "--columns: '{}' does not name x, y and z; expected names such as x,y,z,-,radius",
            printable(words));
    return columns;
}

/// Lines of numbers, perhaps below a line of names.
class TableReader {
public:
    TableReader(const fs::path& file, const std::optional<std::string>& columns)
        : file_(file), text_(readTableText(file)), given_(columns.has_value()) {
        if (!columns) return;
        columns_ = columnsFromWords(*columns);
        requireColumns(file, columns_);
    }

    PointCloud read() {
        std::string_view rest = text_;
        while (!rest.empty()) {
            const std::size_t end = std::min(rest.find('\n'), rest.size());
            const std::string_view line = rest.substr(0, end);
            rest.remove_prefix(std::min(end + 1, rest.size()));
            ++line_;
            if (line.find_first_not_of(" \t") == line.npos) continue;
            if (const std::string_view mark = commentMark(line); !mark.empty()) {
                noteNames(line.substr(line.find(mark) + mark.size()));
                continue;
            }
            row_ = splitRow(line);
            if (first_ && readHeader()) continue;
            readPoint();
        }
        cloud_.columns = columns_.describe();
        if (decimalCommas_)
            cloud_.notes.push_back(fmt::format(
                "{}: commas within numbers are read as decimal points", file_.string()));
        return std::move(cloud_);
    }

private:
    Error wrong(const TableCell& cell, std::string_view expected) const {
        return inputError("{}:{}:{}: '{}' is not {}", file_.string(), line_, cell.column,
                          printable(cell.text.substr(0, 40)), expected);
    }
    bool isNumber(const TableCell& cell) const {
        return cellNumber(cell.text, row_.decimalCommas).has_value();
    }

    /// A comment may hold the names of columns, as in CloudCompare's files.
    void noteNames(std::string_view comment) {
        if (!columns_.is.empty() || given_) return;
        Columns names;
        for (const TableCell& cell : splitRow(comment).cells)
            names.add(cell.text, columnNamed(cell.text));
        if (names.hasPoints()) comment_ = std::move(names);
    }

    /// False where the first line holds numbers already.
    bool readHeader() {
        first_ = false;
        const std::vector<TableCell>& cells = row_.cells;
        const auto numbers = static_cast<std::size_t>(std::count_if(
            cells.begin(), cells.end(), [&](const TableCell& cell) { return isNumber(cell); }));
        if (given_) return numbers == 0;
        if (!isNumber(cells[0])) {
            for (const TableCell& cell : cells) columns_.add(cell.text, columnNamed(cell.text));
            requireColumns(file_, columns_);
            return true;
        }
        if (comment_.is.size() == cells.size()) {
            columns_ = comment_;
            requireColumns(file_, columns_);
            return false;
        }
        if (cells.size() < 3)
            throw inputError(
                "{}:{}: {} number{}; expected x, y and z. Name the columns by a first line of "
                "names, or by --columns",
                file_.string(), line_, cells.size(), cells.size() == 1 ? "" : "s");
        constexpr Column usual[]{Column::X, Column::Y, Column::Z};
        for (std::size_t i = 0; i < cells.size(); ++i)
            columns_.add("", i < 3 ? usual[i] : Column::Other);
        if (cells.size() > 3)
            cloud_.notes.push_back(fmt::format(
                "{} does not name its {} columns: the first three are taken for x, y and z, and "
                "the others are not used. To use them, name all: --columns x,y,z,radius",
                file_.string(), cells.size()));
        return false;
    }

    void readPoint() {
        const std::size_t found = row_.cells.size(), expected = columns_.is.size();
        if (found != expected)
            throw inputError(
                "{}:{}: {} column{}; expected {}{}", file_.string(), line_, found,
                found == 1 ? "" : "s", expected,
                found == 2 * expected
                    ? "; if commas are decimal points, separate the columns by ; or tabs"
                    : "");
        Vec3d point;
        for (std::size_t i = 0; i < found; ++i) {
            if (columns_.is[i] == Column::Other) continue;
            const auto value = cellNumber(row_.cells[i].text, row_.decimalCommas);
            if (!value || !std::isfinite(*value)) throw wrong(row_.cells[i], "a number");
            append(cloud_, columns_.is[i], point, *value);
        }
        decimalCommas_ |= row_.decimalCommas;
        cloud_.points.push_back(point);
    }

    fs::path file_;
    std::string text_;
    bool given_, first_ = true, decimalCommas_ = false;
    std::size_t line_ = 0;
    TableRow row_;
    Columns columns_, comment_;  ///< comment_: as a comment before the first line names them
    PointCloud cloud_;
};

}  // namespace

PointCloud readPoints(const fs::path& file, const std::optional<std::string>& columns) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (extension != ".ply" && extension != ".csv" && extension != ".txt" && extension != ".xyz")
        throw inputError(
            "cannot read points '{}': its name ends in '{}'; expected .ply, .csv, .txt or .xyz",
            file.string(), extension);
    if (extension == ".ply" && columns)
        throw usageError("--columns is for tables, and {} is a PLY file", file.string());
    PointCloud cloud =
        extension == ".ply" ? readPlyPoints(file) : TableReader(file, columns).read();
    if (cloud.points.empty()) throw inputError("{} holds no points", file.string());
    return cloud;
}

}  // namespace woodcock::convert
