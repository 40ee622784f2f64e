// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "woodcock/image/film.h"

namespace woodcock {

/// How many samples each pixel gets: in proportion to its standard error, relative to what is seen,
/// over the root of what a sample of it costs, as the least relative square error for the work
/// demands (Neyman 1934 with costs: Cochran 1977, "Sampling Techniques", 5.5), never fewer than a
/// pilot of equally many. All samples together are the work of so many in every pixel: pixels
/// before nothing cost little, so those that cost much get fewer than a plan by numbers would give
/// them, and a picture takes no longer than with even samples.
///
/// What is seen is the pixel's radiance, or what the scene there adds to a background as bright as
/// the scene, where that is more, as in Film::noise(): so a background that is hidden, black or
/// left to a compositor does not make faint edges matter more than what casts them.
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

    /// Each pixel's samples, row by row over the crop, for the work of `even` samples in every
    /// pixel as the pilot foretells it: of each colour as many as fit into it, short of it by less
    /// than one sample. Grows with `even` in every pixel.
    std::vector<std::uint32_t> counts(int even) const;

    /// Of a render with so many samples for each pixel: long enough to know, short enough to use.
    static int pilotOf(int samples);

private:
    struct PixelPlan {
        std::size_t pixel;
        double share;
        std::uint32_t cost;  ///< of a sample, in small whole parts, so that sums are exact
    };
    void apportion(const std::vector<PixelPlan>& places, int even,
                   std::vector<std::uint32_t>& counts) const;

    std::size_t pixels_;
    std::uint32_t pilot_;
    std::vector<PixelPlan> colours_[2];
};

}  // namespace woodcock
