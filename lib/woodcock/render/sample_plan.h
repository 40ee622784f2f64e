// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "woodcock/image/film.h"

namespace woodcock::render {

/// How many samples each pixel gets. The number is proportional to the pixel's relative standard
/// error, divided by the square root of the cost of a sample there. That gives the least relative
/// square error for the work (Neyman 1934 with costs: Cochran 1977, "Sampling Techniques", 5.5). No
/// pixel gets fewer than the pilot, which takes equally many in all. All samples together take as
/// much work as the same number in every pixel, so a picture takes no longer than with uniform
/// samples. Empty pixels cost little; costly ones get fewer samples than a plan by numbers alone
/// would give them.
///
/// The error is relative to the pixel's radiance; or, where that is more, to its radiance before a
/// background as bright as the scene, as in Film::noise(). So a background that is hidden, black or
/// left to compositing does not make faint edges more important than the objects themselves.
///
/// Unbiased. A pixel whose number of samples depends on the samples themselves tends to stop where
/// they were dark, and its mean is too low (Kirk and Arvo 1991, "Unbiased Sampling Techniques for
/// Image Synthesis"). Here the pixels form a chessboard. The numbers of the black pixels follow
/// from the pilot of the white ones only, and the other way round, including the budget. Pixels are
/// independent, so a pixel's number is independent of its samples, and their plain mean is
/// unbiased. For the same reason there is one pilot and no later update: later samples of the white
/// pixels would depend on the pilot of the black ones.
class SamplePlan {
public:
    /// `pilot` holds the first `samples` samples of every pixel of its crop.
    SamplePlan(const image::Film& pilot, int samples);

    /// What the plan gives a pixel.
    struct Weight {
        double share = 0;        ///< of the samples, in means
        std::uint64_t cost = 0;  ///< of a sample, in small whole parts, so that sums are exact
    };
    /// The same plan, from its weights, row by row over a crop of this width.
    SamplePlan(int width, int samples, const std::vector<Weight>& weights);
    std::vector<Weight> weights() const;
    int pilot() const { return static_cast<int>(pilot_); }

    /// Each pixel's number of samples, row by row over the crop, for the work of `even` samples in
    /// every pixel as the pilot predicts it. Each colour stays below its half of the work by less
    /// than one sample. No number falls as `even` grows.
    std::vector<std::uint32_t> counts(int even) const;

    /// The pilot's number of samples, for a render of `samples` in each pixel.
    static int pilotOf(int samples);

private:
    struct PixelPlan {
        std::size_t pixel;
        double share;
        std::uint64_t cost;
    };
    void apportion(const std::vector<PixelPlan>& places, int even,
                   std::vector<std::uint32_t>& counts) const;

    std::size_t pixels_;
    std::uint32_t pilot_;
    std::vector<PixelPlan> colours_[2];
};

}  // namespace woodcock::render
