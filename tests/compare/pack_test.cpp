// SPDX-License-Identifier: Apache-2.0
#include "woodcock/compare/pack.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace woodcock::test {

using namespace compare;

namespace {

std::vector<unsigned char> unpack(const std::string& text, std::size_t size) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<unsigned char> packed;
    unsigned bits = 0, count = 0;
    for (const char c : text) {
        if (c == '=') break;
        bits = (bits << 6 | static_cast<unsigned>(digits.find(c))) & 0xffff;
        count += 6;
        if (count < 8) continue;
        count -= 8;
        packed.push_back(static_cast<unsigned char>(bits >> count & 255));
    }
    EXPECT_EQ(text.size() % 4, 0u);
    std::vector<unsigned char> bytes(size);
    uLongf found = static_cast<uLongf>(size);
    EXPECT_EQ(uncompress(bytes.data(), &found, packed.data(), static_cast<uLong>(packed.size())),
              Z_OK);
    EXPECT_EQ(found, size);
    return bytes;
}

TEST(Pack, BytesOfAnyLengthComeBack) {
    for (std::size_t size = 0; size < 40; ++size) {
        std::vector<unsigned char> bytes(size);
        for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<unsigned char>(77 * i * i);
        EXPECT_EQ(unpack(packBytes(bytes), size), bytes);
    }
}

TEST(Pack, FloatsKeepFiveDigits) {
    const float most = std::numeric_limits<float>::max(), infinite = INFINITY;
    const std::vector<float> values{0.0f,  1.0f, -1.0f / 3, 1e-30f, 3.14159265f,
                                    65504, most, -infinite, NAN,    -most};
    const std::vector<unsigned char> bytes = unpack(packFloats(values), 3 * values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::uint32_t bits = std::uint32_t{bytes[i]} << 24 |
                                   std::uint32_t{bytes[values.size() + i]} << 16 |
                                   std::uint32_t{bytes[2 * values.size() + i]} << 8;
        float value = 0;
        std::memcpy(&value, &bits, sizeof value);
        if (std::isfinite(values[i]))
            EXPECT_NEAR(value / (values[i] == 0 ? 1 : values[i]), values[i] == 0 ? 0 : 1, 0x1p-16);
        else
            EXPECT_EQ(std::isnan(value), std::isnan(values[i]));
        EXPECT_EQ(std::isinf(value), std::isinf(values[i])) << values[i];
    }
}

}  // namespace
}  // namespace woodcock::test
