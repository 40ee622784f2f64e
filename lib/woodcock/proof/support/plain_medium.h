// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "woodcock/medium/medium.h"
#include "woodcock/proof/support/plain_grid.h"

namespace woodcock::proof {

/// One part of a medium, described by plain grids.
struct PlainPart {
    std::optional<PlainGrid> grid;  ///< none: 1 inside `box`
    Box3d box{};
    Affine3d worldFromIndex{};
    Rgb absorption{0.0f}, scattering{1.0f};
    std::optional<PlainGrid> albedo{};
    Affine3d albedoWorldFromIndex{};
    double g = 0;
};

/// A medium by brute force: Gauss-Legendre between all planes of all voxel lattices, where the
/// integrands are smooth; no Field, no majorants, no walk.
class PlainMedium {
public:
    explicit PlainMedium(std::vector<PlainPart> parts) : parts_(std::move(parts)) {}

    const std::vector<PlainPart>& parts() const { return parts_; }

    /// The same for the renderer.
    medium::Medium medium(double majorantScale = 1, int smallestLog2 = 1,
                          grid::Storage storage = grid::Storage::Float) const;

    Vec3d sigmaT(Vec3d world) const;
    Vec3d sigmaS(const PlainPart& part, Vec3d world) const;

    /// Along [t0, t1] of the ray, per channel.
    Vec3d opticalDepth(Vec3d origin, Vec3d direction, double t0, double t1) const;
    Vec3d transmittance(Vec3d origin, Vec3d direction, double t1) const;
    /// Integral of transmittance x sigma_s of one part along [0, t1]: the chance to be scattered
    /// there first.
    Vec3d scattered(const PlainPart& part, Vec3d origin, Vec3d direction, double t1) const;

private:
    std::vector<double> planes(Vec3d origin, Vec3d direction, double t0, double t1) const;

    std::vector<PlainPart> parts_;
};

/// A ray to test with.
struct TestRay {
    Vec3d origin, direction;
    double tMax;
};

/// Rays of every kind through a medium: from far outside, from inside, along voxel planes, grazing
/// the bounds, ending inside. Finite.
std::vector<TestRay> testRays(const medium::Medium& medium, int count, std::uint64_t seed);

}  // namespace woodcock::proof
