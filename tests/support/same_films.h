// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <bit>

#include "woodcock/image/film.h"

namespace woodcock::test {

/// All sums of two films are the same, bit for bit.
inline void expectSameBits(const image::Film& a, const image::Film& b) {
    ASSERT_TRUE(a.isLike(b));
    const auto left = a.planes(), right = b.planes();
    for (std::size_t i = 0; i < left.size(); ++i)
        for (std::size_t p = 0; p < a.pixelCount(); ++p)
            for (std::size_t c = 0; c < static_cast<std::size_t>(left[i].components); ++c) {
                const std::size_t at = p * left[i].stride + c;
                if (left[i].sums)
                    ASSERT_EQ(std::bit_cast<std::uint64_t>(left[i].sums[at]),
                              std::bit_cast<std::uint64_t>(right[i].sums[at]))
                        << left[i].name << ", pixel " << p;
                else
                    ASSERT_EQ(left[i].counts[at], right[i].counts[at])
                        << left[i].name << ", pixel " << p;
            }
}

}  // namespace woodcock::test
