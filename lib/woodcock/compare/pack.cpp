// SPDX-License-Identifier: Apache-2.0
#include "woodcock/compare/pack.h"

#include <zlib.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "woodcock/base/error.h"

namespace woodcock::compare {

namespace {

/// Rounded to nearest, but not to infinity.
std::uint32_t upperBits(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    if (std::isnan(value)) return 0x7fc000;
    const std::uint32_t rounded = (bits + 0x80) >> 8;
    return std::isfinite(value) && (rounded & 0x7f8000) == 0x7f8000 ? bits >> 8 : rounded;
}

}  // namespace

std::string base64(std::span<const unsigned char> bytes) {
    constexpr const char* digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve(bytes.size() / 3 * 4 + 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t left = bytes.size() - i;
        const unsigned word = unsigned{bytes[i]} << 16 |
                              (left > 1 ? unsigned{bytes[i + 1]} << 8 : 0) |
                              (left > 2 ? unsigned{bytes[i + 2]} : 0);
        text += digits[word >> 18];
        text += digits[word >> 12 & 63];
        text += left > 1 ? digits[word >> 6 & 63] : '=';
        text += left > 2 ? digits[word & 63] : '=';
    }
    return text;
}

std::string packBytes(std::span<const unsigned char> bytes) {
    uLongf size = compressBound(static_cast<uLong>(bytes.size()));
    std::vector<unsigned char> packed(size);
    if (compress2(packed.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), 6) != Z_OK)
        throw failure("cannot compress {} bytes for the report", bytes.size());
    packed.resize(size);
    return base64(packed);
}

std::string packFloats(std::span<const float> values) {
    const std::size_t n = values.size();
    std::vector<unsigned char> bytes(3 * n);
    for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t bits = upperBits(values[i]);
        for (std::size_t k = 0; k < 3; ++k)
            bytes[k * n + i] = static_cast<unsigned char>(bits >> (16 - 8 * k) & 255);
    }
    return packBytes(bytes);
}

}  // namespace woodcock::compare
