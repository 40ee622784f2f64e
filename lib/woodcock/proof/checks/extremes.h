// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/oracles/line_integral.h"

namespace woodcock::proof {

// Parts of extremes(), one file each.
std::vector<Check> extremeDepths();
std::vector<Check> extremeGrids();
std::vector<Check> extremeRays();
std::vector<Check> extremeContrasts();

/// Two digits quickly, more in full: extremes are many.
Precision extremePrecision(const Lab& lab);

/// How to render a picture whose pixels all have one expectation, and its largest cost.
struct Watch {
    std::vector<int> channels{0};
    int side = 32;
    std::optional<int> maxScatterings{};
    /// Cells entered and collisions met, for each flight: of the camera, after a scattering, to a
    /// light. Theory needs one collision at most.
    double mostSteps = 200;
};

/// Like evenPicture(), and adds a case that detects hangs: the steps per flight.
RgbEstimate watch(Lab& lab, const std::string& name, const render::Scene& scene,
                  const Precision& precision, const Watch& how = {});

/// `sigma_a` or so of a float in a scene's text, to all digits.
std::string digits(double value);

inline constexpr const char* evenLight = "[[light]]\ntype = \"environment\"\nradiance = 1\n";

/// A grid that is known as a function, and a scene that absorbs by it.
struct KnownGrid {
    oracle::VoxelFunction voxel;  ///< zero outside the box
    Box3i box;
    Affine3d worldFromIndex;
    double sigma = 1;
    /// Optical depth of a ray in index space, `direction` of any length, to its end.
    double opticalDepth(Vec3d origin, Vec3d direction) const;
};

/// Adds cases of `scene`'s medium (grey, one part) along a line in index space: transmittance by
/// the estimator, and optical depth by the exact integrator.
void addTransmittance(Lab& lab, const std::string& name, const std::string& volume,
                      const KnownGrid& grid, Vec3d origin, Vec3d direction);

}  // namespace woodcock::proof
