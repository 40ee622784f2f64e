// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "woodcock/surface/geometry.h"
#include "woodcock/surface/material.h"

namespace woodcock {

/// What a surface is, wherever its instances stand.
struct SurfaceObject {
    std::string name;  ///< for messages
    std::uint32_t material = 0;
    /// Closed, and light may get inside: a dielectric or an interface. Then what it holds replaces
    /// what is around it; where several such objects overlap, the highest priority wins, and of
    /// equal ones the later object.
    bool holdsMedium = false;
    double ior = 1;            ///< of what it holds
    std::uint32_t medium = 0;  ///< of Scene::media: what it holds; 0 is the outside's
    int priority = 0;
    /// For compositing; each is about camera rays alone.
    bool holdout = false, shadowCatcher = false, matte = false;
    bool cameraVisible = true;
    /// First of this object's triangles in the scene's MeshLight, of each instance in order; none
    /// where it is dark.
    static constexpr std::uint32_t dark = std::numeric_limits<std::uint32_t>::max();
};

/// All surfaces of a scene.
struct SurfaceSet {
    Geometry geometry;
    std::vector<SurfaceObject> objects;
    std::vector<Material> materials;
    /// Of each instance of the geometry: the first of its triangles in the MeshLight, in the order
    /// of its primitives; SurfaceObject::dark where it has none.
    std::vector<std::uint32_t> firstEmitter;
    /// Closed objects in which light travels, by object: for Geometry::enclosing().
    std::vector<bool> holdsMedium() const;
};

}  // namespace woodcock
