// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace woodcock {

namespace {

struct Letter {
    std::uint32_t code = 0;
    std::size_t bytes = 0;  ///< 0: not valid UTF-8
};

/// The first letter of a text that is not empty (RFC 3629: neither overlong, nor a surrogate).
Letter letterOf(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const std::uint32_t first = byte(0);
    if (first < 0x80) return {first, 1};
    const std::size_t bytes = first >= 0xf8   ? 0
                              : first >= 0xf0 ? 4
                              : first >= 0xe0 ? 3
                              : first >= 0xc0 ? 2
                                              : 0;
    if (bytes == 0 || bytes > text.size()) return {};
    std::uint32_t code = first & (0x7fu >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((byte(i) & 0xc0) != 0x80) return {};
        code = code << 6 | (byte(i) & 0x3fu);
    }
    constexpr std::uint32_t least[]{0, 0, 0x80, 0x800, 0x10000};
    if (code < least[bytes] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return {};
    return {code, bytes};
}

bool isHarmful(std::uint32_t code) {
    const auto within = [code](std::uint32_t from, std::uint32_t to) {
        return code >= from && code <= to;
    };
    return code < 0x20 || within(0x7f, 0x9f) ||                 // controls
           code == 0x061c || within(0x200e, 0x200f) ||          // marks of direction
           within(0x2028, 0x202e) || within(0x2066, 0x2069) ||  // line ends, embedded directions
           code == 0xfeff;
}

std::string spelled(std::string_view text, std::string_view staying) {
    std::string out;
    for (std::size_t i = 0; i < text.size();) {
        const Letter letter = letterOf(text.substr(i));
        const std::size_t bytes = std::max<std::size_t>(letter.bytes, 1);
        const std::string_view part = text.substr(i, bytes);
        if (staying.find(text[i]) != std::string_view::npos ||
            (letter.bytes > 0 && !isHarmful(letter.code)))
            out += part;
        else
            for (const char c : part)
                out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
        i += bytes;
    }
    return out;
}

}  // namespace

std::string printable(std::string_view text) { return spelled(text, {}); }

std::string printableLines(std::string_view text) { return spelled(text, "\n\t"); }

std::string shown(std::string_view text, std::size_t most) {
    if (text.size() <= most) return printable(text);
    std::size_t end = most;
    while (end > 0 && end + 4 > most && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80)
        --end;  // between letters
    return printable(text.substr(0, end)) + "...";
}

}  // namespace woodcock
