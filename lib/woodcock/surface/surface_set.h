// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "woodcock/surface/geometry.h"
#include "woodcock/surface/material.h"

namespace woodcock::surface {

/// What a surface is, whatever the transforms of its instances.
struct SurfaceObject {
    std::string name;  ///< for messages
    std::uint32_t material = 0;
    /// Closed, and light may enter: a dielectric or an interface. The medium inside replaces that
    /// around it. Where several such objects overlap, the highest priority counts; of equal ones,
    /// the later object.
    bool holdsMedium = false;
    double ior = 1;            ///< index of refraction of the medium inside
    std::uint32_t medium = 0;  ///< inside: 0 is Scene::medium, else interiorMedia[medium - 1]
    int priority = 0;
    std::uint8_t lightGroup = 0;  ///< the number of that which its own light counts to; 0: none
    /// For compositing; each concerns camera rays only.
    bool holdout = false, shadowCatcher = false, matte = false;
    bool cameraVisible = true;
    /// For each instance, in order: the first of this object's triangles in the scene's MeshLight,
    /// or `dark`.
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

}  // namespace woodcock::surface
