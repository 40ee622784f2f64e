// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace woodcock::compare {

// The difference that an observer notices when flipping between two pictures, from 0 to 1 for each
// pixel. Pictures are linear with Rec.709 primaries, three floats a pixel, row by row, finite;
// negative values count as 0. The default of `pixelsPerDegree` is a 4K screen 0.7 m wide seen from
// 0.7 m.

/// Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images": of pictures on a
/// screen whose white is 1; brighter is clipped.
std::vector<float> flipLdr(std::span<const float> reference, std::span<const float> test, int width,
                           int height, double pixelsPerDegree = 67.0206);

/// Andersson et al. 2021, "Visualizing Errors in Rendered High Dynamic Range Images": the largest
/// over exposures from the one that shows the reference's brightest pixel to the one that shows its
/// median, by the tone mapping of ACES.
std::vector<float> flipHdr(std::span<const float> reference, std::span<const float> test, int width,
                           int height, double pixelsPerDegree = 67.0206);

}  // namespace woodcock::compare
