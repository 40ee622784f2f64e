// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/scene_bounds.h"

#include <algorithm>
#include <cmath>

#include "woodcock/grid/block_ranges.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/unit_shapes.h"

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

constexpr float wisp = 0.01f;
constexpr std::size_t mostPoints = 1 << 20;  // of a surface of which each point is looked at
constexpr double mostBlocks = 1 << 24;       // in a field whose blocks are looked at one by one

void addCorners(const Box3d& box, const Affine3d& toWorld, std::vector<Vec3d>& points) {
    for (int i = 0; i < 8; ++i) points.push_back(toWorld.point(box.corner(i)));
}

Vec3i blockOf(Vec3d p) {
    return Vec3d{std::floor(p.x / 8), std::floor(p.y / 8), std::floor(p.z / 8)}.as<int>();
}

/// The part of the box that lies in the row of blocks along x through (y, z), if any of it is more
/// than a wisp.
Box3d occupiedPart(const grid::Field& field, Vec3i first, Vec3i last) {
    const float least = wisp * field.range().max;
    Box3d part;
    for (Vec3i b = first; b.x <= last.x; ++b.x)
        if (grid::blockRange(field, b).max > least) {
            const Vec3d corner = b.as<double>() * 8;
            part.add(Box3d{corner, corner + Vec3d{8, 8, 8}});
        }
    return part;
}

void addField(const grid::Field& field, const Affine3d& worldFromIndex,
              std::vector<Vec3d>& points) {
    const Box3d extent = field.extent();
    if (extent.empty()) return;
    const Vec3d size = extent.size() / 8 + Vec3d{1, 1, 1};
    if (size.x * size.y * size.z > mostBlocks) return addCorners(extent, worldFromIndex, points);
    const Vec3i first = blockOf(extent.lower), last = blockOf(extent.upper);
    // A row of blocks is as convex as its two ends.
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y) {
            Box3d part = occupiedPart(field, {first.x, y, z}, {last.x, y, z});
            part.lower = max(part.lower, extent.lower);
            part.upper = min(part.upper, extent.upper);
            if (!part.empty()) addCorners(part, worldFromIndex, points);
        }
}

/// In the space of its mesh; none for an infinite plane.
std::vector<Vec3d> pointsOf(const SurfaceDescription& surface, const LoadedSurface& loaded) {
    std::vector<Vec3d> points;
    const auto add = [&](const mesh::SurfaceMesh& mesh) {
        for (const Vec3f& p : mesh.mesh.points) points.push_back(p.as<double>());
    };
    if (loaded.mesh)
        add(*loaded.mesh);
    else if (std::holds_alternative<SphereShape>(surface.shape))
        add(sphereMesh(12));
    else if (std::holds_alternative<DiskShape>(surface.shape))
        add(diskMesh(24));
    return points;
}

void addSurface(const SurfaceDescription& surface, const LoadedSurface& loaded,
                std::vector<Vec3d>& outline) {
    std::vector<Vec3d> points = pointsOf(surface, loaded);
    if (points.size() * loaded.instances.size() > mostPoints) {
        Box3d box;
        for (const Vec3d& p : points) box.add(p);
        points.clear();
        addCorners(box, {}, points);
    }
    for (const Affine3d& instance : loaded.instances) {
        const Affine3d toWorld = surface.worldFromObject * instance * loaded.objectFromMesh;
        for (const Vec3d& p : points) outline.push_back(toWorld.point(p));
    }
}

}  // namespace

std::vector<Vec3d> sceneOutline(const SceneDescription& description, const LoadedScene& loaded) {
    std::vector<Vec3d> points;
    for (size_t i = 0; i < description.volumes.size(); ++i) {
        const VolumeDescription& volume = description.volumes[i];
        const LoadedVolume& fields = loaded.volumes[i];
        if (const auto* box = std::get_if<HomogeneousBox>(&volume.coefficients))
            addCorners(box->box, volume.worldFromObject, points);
        for (const LoadedField* grid :
             {&fields.density, &fields.sigmaA, &fields.sigmaS, &fields.emission, &fields.blackbody})
            if (*grid)
                addField(*grid->field, volume.worldFromObject * grid->objectFromIndex, points);
    }
    for (size_t i = 0; i < description.surfaces.size(); ++i)
        addSurface(description.surfaces[i], loaded.surfaces[i], points);
    if (points.empty()) addCorners({{0, 0, 0}, {1, 1, 1}}, {}, points);
    return points;
}

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
