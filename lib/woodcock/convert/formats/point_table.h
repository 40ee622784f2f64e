// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace woodcock::convert {

/// The text of a table, without a byte order mark, each line ended by '\n'. Errors: Input for
/// UTF-16 and for files that are not text; and those of readInput().
std::string readTableText(const std::filesystem::path& file);

struct TableCell {
    std::string_view text;   ///< without spaces and quotes around it
    std::size_t column = 0;  ///< of the line, from 1
};

struct TableRow {
    std::vector<TableCell> cells;
    bool decimalCommas = false;  ///< commas are decimal points
};

/// The cells between semicolons, else tabs, commas or spaces. Commas and semicolons each end a
/// cell, spaces do so together. Where other separators leave cells such as "1,5", commas are
/// decimal.
TableRow splitRow(std::string_view line);

/// The whole cell as a number.
std::optional<double> cellNumber(std::string_view text, bool decimalComma);

/// The mark of a comment at the beginning of a line: #, // or %; empty where it is none.
std::string_view commentMark(std::string_view line);

}  // namespace woodcock::convert
