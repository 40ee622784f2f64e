// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "woodcock/base/spectrum.h"

namespace woodcock::light {

/// Light that is graded from the horizon upwards and downwards: at an elevation of e degrees,
/// end + (horizon - end) exp(-(e / 14.4)^2), where `end` is `above` or `below`. So half of the way
/// is gone at 12 degrees. A lat-long image, RGB, top row first, as EnvironmentMap takes it; its
/// rows are 0.35 degrees high, and interpolation between them differs by less than 0.1 %.
std::vector<float> gradedImage(Rgb below, Rgb horizon, Rgb above);
inline constexpr int gradedImageWidth = 8, gradedImageHeight = 512;

}  // namespace woodcock::light
