// SPDX-License-Identifier: Apache-2.0
// Against the definition of IEEE halves: 10 digits, exponents of -14 to 15, denormals of 2^-24.
#include "woodcock/grid/half.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace woodcock::test {

using namespace grid;

namespace {

/// All finite halves from 0 upwards, by their bits.
std::vector<float> halves() {
    std::vector<float> values;
    for (int exponent = 0; exponent < 31; ++exponent)
        for (int digits = 0; digits < 1024; ++digits)
            values.push_back(static_cast<float>(
                std::ldexp(exponent ? 1024 + digits : digits, std::max(exponent, 1) - 25)));
    return values;
}

TEST(Half, EveryOneIsEncodedAndDecodedExactly) {
    const std::vector<float> values = halves();
    ASSERT_EQ(values.back(), largestHalf);
    for (std::size_t i = 0; i < values.size(); ++i)
        for (float sign : {1.0f, -1.0f}) {
            const auto bits = static_cast<std::uint16_t>(i | (sign < 0 ? 0x8000u : 0));
            ASSERT_EQ(decodeHalf(bits), sign * values[i]);
            ASSERT_EQ(encodeHalf(sign * values[i]), bits);
            ASSERT_TRUE(isExactAsHalf(sign * values[i]));
        }
}

TEST(Half, OthersAreRoundedToTheNearestAndTiesToTheEvenOne) {
    const std::vector<float> values = halves();
    for (std::size_t i = 0; i + 1 < values.size(); ++i) {
        const float middle = 0.5f * (values[i] + values[i + 1]);  // exact: a float has more digits
        const auto lower = static_cast<std::uint16_t>(i), upper = static_cast<std::uint16_t>(i + 1);
        ASSERT_EQ(encodeHalf(middle), i % 2 ? upper : lower);
        ASSERT_EQ(encodeHalf(std::nextafter(middle, 0.0f)), lower);
        ASSERT_EQ(encodeHalf(std::nextafter(middle, 1e6f)), upper);
        ASSERT_EQ(encodeHalf(std::nextafter(values[i + 1], 0.0f)), upper);
        ASSERT_EQ(encodeHalf(-middle), encodeHalf(middle) | 0x8000u);
        for (float v : {middle, std::nextafter(middle, 0.0f), std::nextafter(values[i + 1], 0.0f)})
            ASSERT_FALSE(isExactAsHalf(v)) << v;
    }
    for (float v : {65504.01f, 65536.0f, 1e38f, INFINITY, -INFINITY, NAN})
        EXPECT_FALSE(isExactAsHalf(v)) << v;
}

}  // namespace
}  // namespace woodcock::test
