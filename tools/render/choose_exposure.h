// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/image/display.h"
#include "woodcock/image/film.h"

namespace woodcock::tool {

/// Where the bright parts of what a picture shows come to lie, as a display value of grey. White
/// is 1.
inline constexpr double brightDisplayValue = 0.84;
/// The share of what a picture shows that is darker than its bright parts.
inline constexpr double brightShare = 0.95;

/// Stops that bring the bright parts of what renderTrial() found to brightDisplayValue through
/// `display`, which has no exposure of its own; within -10 and 10. 0 where there is nothing to be
/// seen.
double chooseExposure(const image::Film& trial, const image::DisplayTransform& display);

/// The radiance (mean of the channels) of the bright parts of a film: a weighted quantile over its
/// blocks of 3 x 3 pixels, in which noise is less; each counts as much as it covers of the
/// background, or glows. 0: there is nothing.
double brightRadiance(const image::Film& film);

}  // namespace woodcock::tool
