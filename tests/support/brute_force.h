// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "woodcock/camera/camera.h"
#include "woodcock/proof/oracles/vdb_values.h"
#include "woodcock/proof/support/estimate.h"

namespace woodcock::test {

/// One channel of one volume: sigma = coefficient x density.
struct BruteVolume {
    const oracle::VdbValues* density;
    Affine3d worldFromIndex;
    double absorption, scattering, g;
    /// Its weight in the choice of a phase function, per unit of density: `scattering` where
    /// physics is meant.
    double phaseWeight;
};

struct BruteScene {
    std::vector<BruteVolume> volumes;
    Vec3d towardsSun;  ///< unit
    double sunIrradiance, environment;
    camera::Camera camera;
};

/// Path tracing at its plainest: Woodcock's (1965) tracking at one majorant for everything, full
/// trilinear lookups, no roulette, no quasi-random numbers, the mixture of phase functions
/// evaluated as a whole, sun by next event and environment by escape. Mean radiance over the
/// pixels [x0, x1) x [y0, y1) of an image of 160 x 160.
proof::Estimate bruteRadiance(const BruteScene& scene, int x0, int y0, int x1, int y1, int samples);

}  // namespace woodcock::test
