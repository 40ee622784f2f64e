// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "woodcock/image/film.h"

namespace woodcock {

/// How many samples each pixel gets: in proportion to its relative standard error over the root of
/// what a sample of it costs, as the least relMSE for the cost demands (Neyman 1934 with costs:
/// Cochran 1977, "Sampling Techniques", 5.5), never fewer than a pilot of equally many.
///
/// Unbiased. A pixel whose number of samples depends on the samples themselves tends to stop where
/// they were dark, and its mean is too low (Kirk and Arvo 1991, "Unbiased Sampling Techniques for
/// Image Synthesis"). Here the pixels form a chessboard: what the black ones get follows from the
/// pilot of the white ones alone, and the other way round, budget included. Pixels are independent,
/// so a pixel's number is independent of its samples, and their plain mean is unbiased. It is why
/// there is one pilot and no second look: later samples of the white ones would depend on the
/// pilot of the black.
class SamplePlan {
public:
    /// `pilot` holds the first `samples` samples of every pixel of its crop.
    SamplePlan(const Film& pilot, int samples);

    /// Each pixel's samples, row by row over the crop, once there are `mean` times as many as
    /// pixels: exactly so many in all (and of each colour). Grows with `mean` in every pixel.
    std::vector<std::uint32_t> counts(int mean) const;

    /// Of a render with so many samples for each pixel: long enough to know, short enough to use.
    static int pilotOf(int samples);

private:
    struct Place {
        std::size_t pixel;
        double share;
    };
    void apportion(const std::vector<Place>& places, std::uint64_t total,
                   std::vector<std::uint32_t>& counts) const;

    std::size_t pixels_;
    std::uint32_t pilot_;
    std::vector<Place> colours_[2];
};

}  // namespace woodcock
