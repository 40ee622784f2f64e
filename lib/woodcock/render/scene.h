// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "woodcock/camera/camera.h"
#include "woodcock/camera/shutter.h"
#include "woodcock/light/light_set.h"
#include "woodcock/medium/medium.h"
#include "woodcock/render/needs.h"
#include "woodcock/surface/surface_set.h"

namespace woodcock::render {

struct NextFrame;

/// A scene as light meets it: scene/ builds it, and a render session renders it. Immutable while
/// rendering and shared by all threads.
struct Scene {
    medium::Medium medium;  ///< outside of all surfaces
    light::LightSet lights;
    camera::Camera camera = {};
    std::shared_ptr<const surface::SurfaceSet> surfaces = {};  ///< null: none
    std::vector<medium::Medium> interiorMedia =
        {};  ///< inside of surfaces: SurfaceObject::medium - 1 is the index
    camera::Shutter shutter = {};
    std::shared_ptr<const NextFrame> next = {};  ///< for the layer of motion; null: none asks
    /// Needs that are run although the scene does not have them, to measure their cost. See
    /// forceNeed() in trade/needs_cost.h.
    Needs forcedNeeds = {};

    /// What each part of a medium belongs to, as StoppedLight::Stop::owner: of `medium`, then of
    /// `interiorMedia`. A surface is owner number firstSurface + its object.
    std::vector<std::vector<std::uint32_t>> partOwners = {};
    std::uint32_t firstSurface = 0;

    /// World box of all finite media and surfaces.
    Box3d bounds() const;
};

}  // namespace woodcock::render
