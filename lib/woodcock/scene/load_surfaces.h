// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/base/vec.h"
#include "woodcock/mesh/surface_mesh.h"
#include "woodcock/scene/description.h"
#include "woodcock/scene/load_cache.h"
#include "woodcock/surface/texture.h"

namespace woodcock::scene {

/// What a surface's description names, or says in numbers.
struct LoadedSurface {
    std::shared_ptr<const mesh::SurfaceMesh>
        mesh;                         ///< null: a sphere, disk or plane without triangles
    Affine3d objectFromMesh;          ///< boxes, say, are all one mesh
    std::vector<Affine3d> instances;  ///< of the description or its file; never empty
};

/// Reads meshes, each file once, and the places of instances. Meshes that have to enclose something
/// are checked, and turned over where they face inwards, which a note tells. Throws Error{Input}
/// with the place in the scene.
std::vector<LoadedSurface> loadSurfaces(const SceneDescription& scene,
                                        std::vector<std::string>& notes, LoadCache& cache);

/// The image of each material, each file read once; null where it has none. Throws Error{Input}
/// with the place in the scene on images that cannot be read, and on such as would make a surface
/// reflect more light than it gets.
std::vector<std::shared_ptr<const surface::TextureImage>> loadTextures(
    const SceneDescription& scene, LoadCache& cache);

/// The description's colour times the image. What reflects is brought down to 1 where rounding put
/// it above.
surface::Texture makeTexture(const TextureDescription& description,
                             std::shared_ptr<const surface::TextureImage> image);

/// World boxes of the instances of a surface, all together; empty for an infinite plane.
Box3d surfaceBounds(const SurfaceDescription& surface, const LoadedSurface& loaded);

/// The places where a surface stands, from a text file with a line for each: `x y z`; `x y z
/// scale`; `x y z scale rx ry rz` (degrees, about x, y and z in this order, after scaling); or the
/// 12 numbers of a matrix, its upper three rows one after the other. What follows a # is a comment.
/// Throws Error{Input} that names the file and the line.
std::vector<Affine3d> readInstanceFile(const std::filesystem::path& file);

}  // namespace woodcock::scene
