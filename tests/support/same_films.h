// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <vector>

#include "woodcock/image/deep_state.h"
#include "woodcock/image/film.h"
#include "woodcock/image/matte_film.h"

namespace woodcock::test {

/// All numbers of these planes of so many pixels are the same, bit for bit.
inline void expectSameBits(const std::vector<image::Film::ConstPlane>& left,
                           const std::vector<image::Film::ConstPlane>& right, std::size_t pixels) {
    ASSERT_EQ(left.size(), right.size());
    for (std::size_t i = 0; i < left.size(); ++i) {
        ASSERT_EQ(left[i].components, right[i].components) << left[i].name;
        for (std::size_t p = 0; p < pixels; ++p)
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
}

/// All sums of two films are the same, bit for bit.
inline void expectSameBits(const image::Film& a, const image::Film& b) {
    ASSERT_TRUE(a.isLike(b));
    expectSameBits(a.planes(), b.planes(), a.pixelCount());
}

inline void expectSameBits(const image::MatteFilm& a, const image::MatteFilm& b) {
    ASSERT_TRUE(a.isLike(b));
    const image::Film::Window& w = a.crop();
    expectSameBits(a.planes(), b.planes(), static_cast<std::size_t>(w.width() * w.height()));
}

inline void expectSameBits(const image::DeepFilm& a, const image::DeepFilm& b) {
    ASSERT_EQ(a.crop(), b.crop());
    const image::DeepState one(a), other(b);
    ASSERT_EQ(one.facts(), other.facts());
    const image::Film::Window& w = a.crop();
    expectSameBits(one.planes(), other.planes(), static_cast<std::size_t>(w.width() * w.height()));
}

}  // namespace woodcock::test
