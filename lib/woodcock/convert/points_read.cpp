// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "woodcock/grid/input_file.h"
#include "woodcock/mesh/ply_file.h"
#include "woodcock/convert/points_to_density.h"
#include "woodcock/base/error.h"

namespace woodcock {

namespace {

namespace fs = std::filesystem;

enum class Column { X, Y, Z, Radius, Width, Weight, Other };

Column columnNamed(std::string_view name) {
    constexpr std::pair<std::string_view, Column> known[]{{"x", Column::X},
                                                          {"y", Column::Y},
                                                          {"z", Column::Z},
                                                          {"radius", Column::Radius},
                                                          {"pscale", Column::Radius},
                                                          {"width", Column::Width},
                                                          {"density", Column::Weight},
                                                          {"weight", Column::Weight},
                                                          {"value", Column::Weight}};
    for (const auto& [word, column] : known)
        if (word == name) return column;
    return Column::Other;
}

/// The next point gets this value of the column.
void append(PointCloud& cloud, Column column, Vec3f& point, float value) {
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
            cloud.radii.push_back(value);
            break;
        case Column::Width:
            cloud.radii.push_back(value / 2);
            break;
        case Column::Weight:
            cloud.weights.push_back(value);
            break;
        case Column::Other:
            break;
    }
}

/// Two columns that say the same would give a point two radii.
void requireColumns(const fs::path& file, const std::vector<Column>& columns) {
    const auto count = [&](auto... c) {
        return std::count_if(columns.begin(), columns.end(),
                             [&](Column column) { return ((column == c) || ...); });
    };
    if (count(Column::X) != 1 || count(Column::Y) != 1 || count(Column::Z) != 1)
        throw inputError("{}: expected one x, one y and one z of each point", file.string());
    if (count(Column::Radius, Column::Width) > 1)
        throw inputError("{}: more than one of radius, pscale and width", file.string());
    if (count(Column::Weight) > 1)
        throw inputError("{}: more than one of density, weight and value", file.string());
}

PointCloud readPlyPoints(const fs::path& file) {
    const std::vector<PlyElement> elements = readPly(file);
    const auto vertices = std::find_if(elements.begin(), elements.end(),
                                       [](const PlyElement& e) { return e.name == "vertex"; });
    if (vertices == elements.end()) throw inputError("{} has no vertices", file.string());
    std::vector<Column> columns;
    for (const PlyElement::Property& property : vertices->properties)
        columns.push_back(property.isList ? Column::Other : columnNamed(property.name));
    requireColumns(file, columns);
    PointCloud cloud;
    for (std::size_t i = 0; i < vertices->count; ++i) {
        Vec3f point;
        for (std::size_t c = 0; c < columns.size(); ++c)
            if (columns[c] != Column::Other)
                append(cloud, columns[c], point,
                       static_cast<float>(vertices->properties[c].values[i]));
        cloud.points.push_back(point);
    }
    return cloud;
}

/// Lines of numbers between commas, semicolons or spaces.
class TableReader {
public:
    explicit TableReader(const fs::path& file) : file_(file), text_(readInput(file)) {}

    PointCloud read() {
        std::string_view rest = text_;
        while (!rest.empty()) {
            const std::size_t end = std::min(rest.find('\n'), rest.size());
            std::string_view line = rest.substr(0, end);
            rest.remove_prefix(std::min(end + 1, rest.size()));
            ++line_;
            if (line.ends_with('\r')) line.remove_suffix(1);
            split(line);
            if (cells_.empty() || line[line.find_first_not_of(" \t")] == '#') continue;
            if (columns_.empty() && readHeader()) continue;
            readPoint();
        }
        return std::move(cloud_);
    }

private:
    struct Cell {
        std::string_view text;
        std::size_t column = 0;
    };

    Error wrong(const Cell& cell, std::string_view expected) const {
        return inputError("{}:{}:{}: '{}' where {} is expected", file_.string(), line_, cell.column,
                          cell.text.substr(0, 40), expected);
    }

    /// Commas and semicolons each end a cell, spaces do so together.
    void split(std::string_view line) {
        constexpr std::string_view spaces = " \t", ends = ",;";
        cells_.clear();
        const bool hasEnds = line.find_first_of(ends) != std::string_view::npos;
        for (std::size_t at = 0; at <= line.size();) {
            const std::size_t begin = std::min(line.find_first_not_of(spaces, at), line.size());
            if (!hasEnds && begin == line.size()) break;
            std::size_t end =
                std::min(line.find_first_of(hasEnds ? ends : spaces, begin), line.size());
            std::string_view text = line.substr(begin, end - begin);
            while (!text.empty() && spaces.find(text.back()) != std::string_view::npos)
                text.remove_suffix(1);
            cells_.push_back({text, begin + 1});
            at = end + 1;
        }
    }

    static std::optional<float> numberIn(std::string_view text) {
        if (text.starts_with('+')) text.remove_prefix(1);
        double v = 0;
        const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), v);
        if (error != std::errc() || stop != text.data() + text.size()) return {};
        return static_cast<float>(v);
    }

    /// False where the first line holds numbers already.
    bool readHeader() {
        if (numberIn(cells_[0].text)) {
            constexpr std::array usual{Column::X, Column::Y, Column::Z, Column::Radius,
                                       Column::Weight};
            if (cells_.size() < 3 || cells_.size() > usual.size())
                throw inputError(
                    "{}:{}: {} numbers, where x y z and perhaps radius and density are expected; a "
                    "first line of names says what they are",
                    file_.string(), line_, cells_.size());
            columns_.assign(usual.begin(),
                            usual.begin() + static_cast<std::ptrdiff_t>(cells_.size()));
            return false;
        }
        for (const Cell& cell : cells_) {
            std::string name(cell.text);
            if (name.size() > 1 && name.front() == '"' && name.back() == '"')
                name = name.substr(1, name.size() - 2);
            for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
            columns_.push_back(columnNamed(name));
        }
        requireColumns(file_, columns_);
        return true;
    }

    void readPoint() {
        if (cells_.size() != columns_.size())
            throw inputError("{}:{}: {} columns where {} are expected", file_.string(), line_,
                             cells_.size(), columns_.size());
        Vec3f point;
        for (std::size_t i = 0; i < cells_.size(); ++i) {
            if (columns_[i] == Column::Other) continue;
            const std::optional<float> value = numberIn(cells_[i].text);
            if (!value || !std::isfinite(*value)) throw wrong(cells_[i], "a number");
            append(cloud_, columns_[i], point, *value);
        }
        cloud_.points.push_back(point);
    }

    fs::path file_;
    std::string text_;
    std::size_t line_ = 0;
    std::vector<Cell> cells_;
    std::vector<Column> columns_;
    PointCloud cloud_;
};

}  // namespace

PointCloud readPoints(const fs::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (extension != ".ply" && extension != ".csv" && extension != ".txt" && extension != ".xyz")
        throw inputError(
            "cannot read points '{}': its name ends in '{}', where .ply, .csv, .txt or .xyz is "
            "expected",
            file.string(), extension);
    PointCloud cloud = extension == ".ply" ? readPlyPoints(file) : TableReader(file).read();
    if (cloud.points.empty()) throw inputError("{} holds no points", file.string());
    return cloud;
}

}  // namespace woodcock
