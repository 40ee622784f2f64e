// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "woodcock/scene/load.h"

namespace woodcock::tool {

/// How Cycles is to draw a scene.
struct CyclesSettings {
    std::string mode;           ///< "null", "biased", or empty for what the version does at best
    double stepRate = 0.1;      ///< of "biased": a step's length in voxels' terms
    std::string interpolation;  ///< of grids: "stochastic", "trilinear", or empty as mode
    int threads = 0;            ///< 0: one for each core
    bool draw = true;           ///< else the scene is only built
    bool save = false;          ///< as a .blend file
};

/// A complete scene (see completeScene) as JSON for tools/blender/render_in_cycles.py: everything
/// resolved and in Cycles' terms. Throws Error{Input} that names what Cycles cannot express.
std::string cyclesScene(const scene::SceneDescription& scene, const scene::LoadedScene& loaded,
                        const CyclesSettings& settings);

}  // namespace woodcock::tool
