// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/light/light_set.h"

namespace woodcock::light {

/// The mean radiance, over all directions, of a light that rays meet where they escape. By evenly
/// spread points: roughly, where it is not the same everywhere.
Rgb meanRadiance(const LightSet& lights, int light);

/// The irradiance of a surface that faces a light that is far away: the mean of some samples.
Rgb irradiance(const LightSet& lights, int light);

/// Whether rays that escape meet the light, and its radiance differs so little from its mean that
/// sampling it is not worth the shadow rays: paths find its light well enough where they leave.
bool isEven(const LightSet& lights, int light);

}  // namespace woodcock::light
