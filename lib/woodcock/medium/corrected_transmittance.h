// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/base/random.h"
#include "woodcock/medium/depth_grid.h"

namespace woodcock::medium {

struct TrackingCounters;

/// Corrections are made at least so often, also where the grid seems sure: what it cannot see, such
/// as a gap between its lines, must not come back as a rare spark.
inline constexpr float rarestCorrection = 1.0f / 256;

/// An unbiased estimate of the transmittance of a medium from a point to infinity, by a grid of the
/// optical depth as control variate:
///
///     T = T_grid + B (T_exact - T_grid) / p,    B = 1 with probability p, else 0.
///
/// Whatever the grid holds, the mean is T_exact. What it holds decides how large the noise is, so
/// `p` is large where the grid's nodes around the point differ. The correction has no noise of its
/// own, which 1 / p would multiply. The principle is two-level Monte Carlo: Giles 2008; for light
/// transport Dereviannykh et al. 2025, "Neural Two-Level Monte Carlo Real-Time Rendering".
///
/// `direction`: unit, the grid's or close to it. `weight`: of each channel, what the transmittance
/// will be multiplied by, as a multiple of what matters in the picture; it decides the effort
/// alone. An estimate may be negative, or above 1.
template <int N>
Spectrum<N> correctedTransmittance(const Medium& medium, const DepthGrid& grid, Vec3d origin,
                                   Vec3d direction, Spectrum<N> weight, RandomStream& random,
                                   TrackingCounters& counters);

}  // namespace woodcock::medium
