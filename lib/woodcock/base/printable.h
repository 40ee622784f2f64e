// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace woodcock {

/// The text, safe within one line of a message. Bytes that could break the line, control a terminal
/// or change the order of letters are written as \x0a. These are control characters (C0, DEL, C1),
/// the Unicode marks of direction and of line ends, and bytes that are not UTF-8.
std::string printable(std::string_view text);

/// The same for a text of several lines: line ends and tabs stay.
std::string printableLines(std::string_view text);

/// The printable text as a message quotes it: at most `most` bytes of it, then "...".
std::string shown(std::string_view text, std::size_t most = 200);

}  // namespace woodcock
