// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/base/spectrum.h"
#include "woodcock/base/vec.h"

namespace woodcock::medium {

struct Medium;
struct TrackingCounters;

/// Exact optical depth of every channel along [t0, t1] of a world ray (no randomness, up to
/// rounding): trilinear density is a cubic along a ray inside a cell of the voxel lattice, where
/// two-point Gauss-Legendre is exact; nearest lookups are constant between planes halfway between
/// voxels. Slow: the reference for the estimators. Not for parts whose extinctionVaries().
///
/// The density of a part that moves is no polynomial along a ray. It is integrated at the ray's
/// time by eight points for each voxel's width: not exact.
Rgb exactOpticalDepth(const Medium& medium, Vec3d origin, Vec3d direction, double t0, double t1,
                      float time = 0);

/// exp(-exactOpticalDepth()) over all of a world ray that has no end, in double precision; 0 once
/// the depth of every channel is beyond what a float holds. Counts its pieces as segments.
template <int N>
Spectrum<N> exactTransmittance(const Medium& medium, Vec3d origin, Vec3d direction,
                               TrackingCounters& counters);

/// A point on a world ray, and the optical depth of each channel up to there.
struct DepthAlong {
    const Medium& medium;
    Vec3d origin, direction;
    float time = 0;  ///< of the ray
    double t = 0;
    Vec3d depth = {};
};

/// Goes on from a point to where the transmittance, mean over channels, falls to a value, at most
/// to `tMax`, which may be infinite. Returns whether it falls so far; where it does not, the point
/// goes to tMax, or to where nothing follows. By exactOpticalDepth(), piece after piece and by
/// false position in the last one: to 1e-7 of the transmittance or of the distance.
bool findTransmittance(DepthAlong& along, double tMax, double transmittance);

}  // namespace woodcock::medium
