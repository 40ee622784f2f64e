// SPDX-License-Identifier: Apache-2.0
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "woodcock/base/error.h"
#include "woodcock/grid/vdb/file.h"
#include "woodcock/grid/vdb/openvdb_exact_copy.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_transform.h"
#include "woodcock/grid/vdb/openvdb_trees.h"
#include "woodcock/grid/vdb/read_grids.h"
#include "woodcock/mesh/surface_mesh.h"

namespace woodcock::mesh {

namespace {

namespace fs = std::filesystem;

const grid::GridListing& chooseLevelSet(const grid::VdbFile& file, const std::string& name) {
    const grid::GridListing* found = nullptr;
    for (const grid::GridListing& grid : file.grids) {
        const bool named = grid.uniqueName == name || grid.name == name;
        if (name.empty() ? grid.gridClass != grid::GridClass::LevelSet : !named) continue;
        if (found && name.empty())
            throw inputError("{} holds several level sets: {}; name one of them",
                             file.path.string(), grid::describeGrids(file));
        if (!found) found = &grid;
    }
    if (!found)
        throw inputError("{} in {}; it has: {}",
                         name.empty() ? "no level set" : fmt::format("no grid '{}'", name),
                         file.path.string(), grid::describeGrids(file));
    if (found->gridClass != grid::GridClass::LevelSet)
        throw inputError("grid '{}' of {} is not a level set: its class is '{}'", found->uniqueName,
                         file.path.string(), grid::gridClassName(found->gridClass));
    if (!grid::isReadable(*found) || found->channels != 1)
        throw inputError("level set '{}' of {} cannot be read: it holds {}", found->uniqueName,
                         file.path.string(), found->valueType);
    return *found;
}

template <class GridT>
SurfaceMesh meshOf(const GridT& grid, double adaptivity, const std::string& place) {
    for (auto it = grid.cbeginValueAll(); it; ++it)
        if (std::isnan(*it))
            throw inputError("{} holds a NaN at [{}, {}, {}]", place, it.getCoord().x(),
                             it.getCoord().y(), it.getCoord().z());
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<openvdb::Vec4I> quads;
    SurfaceMesh surface;
    TriangleMesh mesh;
    // The same voxels, moved to where floats are precise.
    const openvdb::CoordBBox active = grid.evalActiveVoxelBoundingBox();
    const openvdb::BBoxd world = grid.transform().indexToWorld(
        openvdb::BBoxd(active.min().asVec3d(), active.max().asVec3d()));
    const auto vec = [](const openvdb::Vec3d& v) { return Vec3d{v[0], v[1], v[2]}; };
    mesh.origin = originFor({vec(world.min()), vec(world.max())});
    const auto transform = grid::exactCopy(grid.transform());
    if (!(mesh.origin == Vec3d{}))
        transform->postTranslate({-mesh.origin.x, -mesh.origin.y, -mesh.origin.z});
    const auto local = grid.copyReplacingTransform(transform);
    openvdb::tools::volumeToMesh(*local, points, triangles, quads, 0.0, adaptivity);
    for (const openvdb::Vec3s& p : points) mesh.points.push_back({p[0], p[1], p[2]});
    for (const openvdb::Vec3I& t : triangles) mesh.triangles.push_back({t[0], t[1], t[2]});
    for (const openvdb::Vec4I& q : quads) {
        mesh.triangles.push_back({q[0], q[1], q[2]});
        mesh.triangles.push_back({q[0], q[2], q[3]});
    }
    surface.mesh = weld(mesh);
    if (surface.mesh.triangles.empty()) throw inputError("{} has no surface", place);
    // OpenVDB's polygons are clockwise from outside, in the grid's own space.
    if (grid::affineOf(*grid.transform().baseMap()).determinant() > 0) flip(surface);
    return surface;
}

}  // namespace

SurfaceMesh levelSetMesh(const fs::path& path, const std::string& name, double adaptivity) {
    if (!(adaptivity >= 0 && adaptivity <= 1))
        throw usageError("an adaptivity of {}; it must be from 0 to 1", adaptivity);
    const grid::VdbFile file = grid::listGrids(path);
    const grid::GridListing& listing = chooseLevelSet(file, name);
    const openvdb::GridBase::Ptr grid =
        grid::readVdbGrids(file, {listing.uniqueName}).grids.front();
    const std::string place =
        fmt::format("level set '{}' of {}", listing.uniqueName, path.string());
    if (grid->isType<openvdb::FloatGrid>())
        return meshOf(static_cast<const openvdb::FloatGrid&>(*grid), adaptivity, place);
    if (grid->isType<openvdb::DoubleGrid>())
        return meshOf(static_cast<const openvdb::DoubleGrid&>(*grid), adaptivity, place);
    throw inputError("{} holds {}; expected float or double", place, grid->valueType());
}

}  // namespace woodcock::mesh
