// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "tools/cycles/scene.h"

namespace woodcock::tool {

struct CyclesOptions {
    CyclesSettings settings;
    std::string blender;          ///< program; empty: the one that is found
    std::filesystem::path image;  ///< EXR to write; empty: none is drawn
    std::filesystem::path blend;  ///< .blend file to write; empty: none
    std::string commandLine;      ///< for the image's header
    std::function<void(double fraction)> onProgress = [](double) {};
    std::function<bool()> shouldStop = [] { return false; };
};

struct CyclesResult {
    bool stopped = false;       ///< nothing was written
    std::string version;        ///< Blender's, such as "5.0.1"
    std::string mode;           ///< null or biased
    std::string interpolation;  ///< of grids: stochastic or trilinear
    double seconds = 0;         ///< of the render alone
};

/// Draws a complete scene (see completeScene) with Blender's Cycles; the image's header says by
/// which version, and how. Throws Error: Usage where there is no Blender, Input that names what
/// this version's Cycles cannot express, Failure with the last lines of a Blender that failed.
CyclesResult renderWithCycles(const scene::SceneDescription& scene,
                              const scene::LoadedScene& loaded, const CyclesOptions& options);

}  // namespace woodcock::tool
