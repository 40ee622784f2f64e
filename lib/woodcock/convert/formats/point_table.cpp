// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/formats/point_table.h"

#include <algorithm>

#include "woodcock/base/error.h"
#include "woodcock/convert/formats/number_text.h"
#include "woodcock/grid/input_file.h"

namespace woodcock::convert {

namespace {

constexpr std::string_view spaces = " \t";

bool hasSpaceWithin(const TableCell& cell) {
    return cell.text.find_first_of(spaces) != cell.text.npos;
}

/// "1,5" or "-12,25e3": one comma, between digits.
bool isDecimalComma(std::string_view text) {
    const std::size_t comma = text.find(',');
    if (comma == text.npos || comma == 0 || text.find(',', comma + 1) != text.npos) return false;
    const auto isDigit = [&](std::size_t i) {
        return i < text.size() && text[i] >= '0' && text[i] <= '9';
    };
    return isDigit(comma - 1) && isDigit(comma + 1) && cellNumber(text, true).has_value();
}

std::vector<TableCell> splitAt(std::string_view line, char separator) {
    std::vector<TableCell> cells;
    for (std::size_t at = 0; at <= line.size();) {
        const std::size_t begin = std::min(line.find_first_not_of(spaces, at), line.size());
        std::size_t end = std::min(line.find(separator, at), line.size());
        if (begin < line.size() && line[begin] == '"' && begin < end) {
            const std::size_t close = line.find('"', begin + 1);
            if (close != line.npos) {
                end = std::min(line.find(separator, close), line.size());
                cells.push_back({line.substr(begin + 1, close - begin - 1), begin + 1});
                at = end + 1;
                continue;
            }
        }
        std::string_view text = line.substr(std::min(begin, end), end - std::min(begin, end));
        while (!text.empty() && spaces.find(text.back()) != spaces.npos) text.remove_suffix(1);
        cells.push_back({text, std::min(begin, end) + 1});
        at = end + 1;
    }
    return cells;
}

std::vector<TableCell> splitAtSpaces(std::string_view line) {
    std::vector<TableCell> cells;
    for (std::size_t at = 0;;) {
        const std::size_t begin = line.find_first_not_of(spaces, at);
        if (begin == line.npos) return cells;
        const bool quoted = line[begin] == '"' && line.find('"', begin + 1) != line.npos;
        const std::size_t from = begin + (quoted ? 1 : 0);
        const std::size_t end = quoted ? line.find('"', from)
                                       : std::min(line.find_first_of(spaces, begin), line.size());
        cells.push_back({line.substr(from, end - from), begin + 1});
        at = end + (quoted ? 1 : 0);
    }
}

/// Whether commas within the cells are decimal: there are some, and each is in a number.
bool haveDecimalCommas(const std::vector<TableCell>& cells) {
    bool any = false;
    for (const TableCell& cell : cells) {
        if (cell.text.find(',') == cell.text.npos) continue;
        if (!isDecimalComma(cell.text)) return false;
        any = true;
    }
    return any;
}

}  // namespace

std::string readTableText(const std::filesystem::path& file) {
    std::string text = grid::readInput(file);
    if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
    const bool marked = text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff");
    if (marked || text.find('\0') < 64)
        throw inputError(
            "{} is {}; save it as text in UTF-8 (in a spreadsheet: CSV UTF-8)", file.string(),
            marked ? "text in UTF-16" : "not text, or text in UTF-16: it has zero bytes");
    for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] == '\r' && (i + 1 == text.size() || text[i + 1] != '\n')) text[i] = '\n';
    std::erase(text, '\r');
    return text;
}

TableRow splitRow(std::string_view line) {
    const auto has = [&](char c) { return line.find(c) != line.npos; };
    if (has(';')) {
        TableRow row{splitAt(line, ';')};
        row.decimalCommas = haveDecimalCommas(row.cells);
        return row;
    }
    if (has('\t')) {
        TableRow row{splitAt(line, '\t')};
        const bool spaced = std::any_of(row.cells.begin(), row.cells.end(), hasSpaceWithin);
        row.decimalCommas = haveDecimalCommas(row.cells);
        if (!spaced && (row.decimalCommas || !has(','))) return row;
    }
    if (has(',')) {
        TableRow row{splitAt(line, ',')};
        if (std::none_of(row.cells.begin(), row.cells.end(), hasSpaceWithin)) return row;
        TableRow spaced{splitAtSpaces(line)};
        spaced.decimalCommas = haveDecimalCommas(spaced.cells);
        return spaced.decimalCommas ? spaced : row;
    }
    return {splitAtSpaces(line)};
}

std::optional<double> cellNumber(std::string_view text, bool decimalComma) {
    if (!decimalComma || text.find(',') == text.npos) return parseDouble(text);
    std::string pointed(text);
    pointed[pointed.find(',')] = '.';
    return parseDouble(pointed);
}

std::string_view commentMark(std::string_view line) {
    line.remove_prefix(std::min(line.find_first_not_of(spaces), line.size()));
    for (const std::string_view mark : {"#", "//", "%"})
        if (line.starts_with(mark)) return line.substr(0, mark.size());
    return {};
}

}  // namespace woodcock::convert
