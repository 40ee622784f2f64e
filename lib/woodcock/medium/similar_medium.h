// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/medium/medium.h"

namespace woodcock::medium {

/// An isotropic medium in which light spreads as in `medium` after many scatterings: sigma_s' = (1
/// - g) sigma_s, sigma_a' = sigma_a, g' = 0 for each part, with g the mean cosine of its phase
/// function, of whatever kind. The similarity relation of order 1, (1 -
/// g) sigma_s = (1 - g') sigma_s': Wyman, Patterson and Wilson 1989, "Similarity Relations for the
/// Interaction Parameters in Radiation Transport", and Zhao, Ramamoorthi and Bala 2014, "High-Order
/// Similarity Relations in Radiative Transfer". Where g < 0 it scatters more.
///
/// Shares the fields and their bounds. Colour and scattering stay, so the Needs of `medium` hold.
/// Emission is left out. Throws Error{Usage} for a chromatic phase function beside a grid of
/// albedo.
Medium similarMedium(const Medium& medium);

}  // namespace woodcock::medium
