// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "woodcock/base/statistics.h"
#include "woodcock/render/camera_depths.h"
#include "woodcock/render/light_depths.h"
#include "woodcock/render/radiance_lattice.h"
#include "woodcock/render/scene.h"

namespace woodcock::proof {

/// Pictures of a few pixels, many of which are rendered by different seeds.
struct SmallPicture {
    int side = 6, samples = 4;
    std::optional<int> maxScatterings{};
    bool lanes = true;                                   ///< see PathTracer::Options
    const render::LightDepths* lightDepths = nullptr;    ///< the same
    const render::CameraDepths* cameraDepths = nullptr;  ///< the same
    const render::RadianceLattice* radiance = nullptr;   ///< the same
};

/// Means over a small picture, of which each seed's is a sample.
struct SmallPictureMeans {
    std::array<Moments, 3> radiance;  ///< of the whole
    std::array<Moments, 4> quarters;  ///< of green, by rows
    Moments alpha;
};
SmallPictureMeans meansOf(const render::Scene& scene, const SmallPicture& picture,
                          std::uint64_t firstSeed, int seeds);

/// Whether the paths of such pictures are traced in lanes.
bool inLanes(const render::Scene& scene, const SmallPicture& picture);

}  // namespace woodcock::proof
