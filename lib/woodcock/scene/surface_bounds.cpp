// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/surface_bounds.h"

#include <algorithm>

#include "woodcock/scene/build.h"
#include "woodcock/scene/outline.h"

namespace woodcock::scene {
namespace {

Box3d meshBounds(const LoadedSurface& loaded) {
    if (!loaded.mesh) return {{-1, -1, -1}, {1, 1, 1}};
    Box3d box;
    for (const Vec3f& p : loaded.mesh->mesh.points) box.add(p.as<double>());
    return box;
}

bool infinite(const SurfaceDescription& surface) {
    const auto* plane = std::get_if<PlaneShape>(&surface.shape);
    return plane && !plane->size;
}

Box3d grown(const Box3d& box, double by) {
    const Vec3d all = Vec3d{1, 1, 1} * by;
    return {box.lower - all, box.upper + all};
}

double largestCoordinate(const Box3d& box) {
    double largest = 0;
    for (int i = 0; i < 3; ++i)
        largest = std::max({largest, std::abs(box.lower[i]), std::abs(box.upper[i])});
    return largest;
}

}  // namespace

Box3d surfaceBounds(const SurfaceDescription& surface, const LoadedSurface& loaded) {
    Box3d bounds;
    if (infinite(surface)) return bounds;
    const Box3d mesh = meshBounds(loaded);
    for (const Affine3d& instance : loaded.instances)
        bounds.add((surface.worldFromObject * instance * loaded.objectFromMesh).box(mesh));
    return bounds;
}

Box3d spaceAround(const SceneDescription& scene, const LoadedScene& loaded, size_t index) {
    const Box3d bounds = surfaceBounds(scene.surfaces[index], loaded.surfaces[index]);
    // Of hits, floats may lose 1e-6.
    if (!bounds.empty())
        return grown(bounds, 0.01 * length(bounds.size()) + 1e-5 * largestCoordinate(bounds));
    Box3d all;
    for (const Vec3d& p : sceneOutline(scene, loaded)) all.add(p);
    if (scene.camera.pose) all.add(worldFromCamera(*scene.camera.pose).translation);
    for (const Affine3d& instance : loaded.surfaces[index].instances)
        all.add((scene.surfaces[index].worldFromObject * instance).translation);
    return grown(all, 1e9 * length(all.size()));
}

}  // namespace woodcock::scene
