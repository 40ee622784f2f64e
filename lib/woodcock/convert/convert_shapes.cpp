// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "woodcock/base/error.h"
#include "woodcock/convert/level_set_to_fog.h"
#include "woodcock/convert/mesh_to_fog.h"
#include "woodcock/convert/openvdb_convert_source.h"
#include "woodcock/convert/points_to_density.h"
#include "woodcock/grid/openvdb_transform.h"
#include "woodcock/mesh/ply_file.h"

namespace woodcock {

namespace fs = std::filesystem;

namespace {

constexpr int usualResolution = 256;

/// The size of voxels that is asked for, else a part of the longest side.
double voxelFor(const Box3d& bounds, const ConvertOptions& options) {
    if (options.placement.size || options.placement.sizeSides || options.placement.origin)
        throw usageError("--size and --origin are for grids of voxels; shapes lie where they are");
    if (options.placement.voxelSides)
        throw usageError("--voxel takes one number for shapes: their voxels are cubes");
    if (options.placement.voxel) return *options.placement.voxel;
    const Vec3d size = bounds.size();
    const double longest = std::max({size.x, size.y, size.z});
    if (!(longest > 0))
        throw usageError("all points are one: the size of voxels must be given, by --voxel");
    const double voxel = longest / usualResolution;
    say(options.info, fmt::format("voxels of {:.4g}: {} along the longest side; see --voxel", voxel,
                                  usualResolution));
    return voxel;
}

/// Turned, remapped and named as the options say.
Source finish(VdbGrids grids, const fs::path& in, const std::vector<std::string>& notes,
              const ConvertOptions& options) {
    for (const std::string& note : notes) say(options.warn, note);
    Source source{std::move(grids), {}};
    for (const openvdb::GridBase::Ptr& grid : source.grids.grids) {
        if (options.axes.identity()) continue;
        const double voxel = grid->voxelSize().x();
        grid->setTransform(
            openVdbTransform(options.axes.map() * Affine3d::scale({voxel, voxel, voxel})));
    }
    ValueSummary found;
    if (!options.values.remap.identity() || options.values.tolerance > 0) {
        remapGrids(source.grids, options.values, found);
        say(options.warn, requireSound(found, in.string(), options.values.repair));
    }
    return source;
}

template <class Options>
Options withNameAndVoxel(double voxel, const ConvertOptions& options) {
    Options result;
    result.voxel = voxel;
    if (options.name) result.name = *options.name;
    return result;
}

}  // namespace

Source readMeshSource(const fs::path& in, const ConvertOptions& options) {
    const TriangleMesh mesh = readMesh(in);
    say(options.info, fmt::format("read {}: {} triangles, {} points", in.string(),
                                  mesh.triangles.size(), mesh.points.size()));
    auto how = withNameAndVoxel<MeshToFogOptions>(voxelFor(boundsOf(mesh), options), options);
    how.band = options.band.value_or(0);
    how.shell = options.shell;
    std::vector<std::string> notes;
    VdbGrids fog = meshToFog(mesh, how, notes);
    return finish(std::move(fog), in, notes, options);
}

Source readPointsSource(const fs::path& in, const ConvertOptions& options) {
    const PointCloud cloud = readPoints(in);
    say(options.info, fmt::format("read {}: {} points", in.string(), cloud.points.size()));
    Box3d bounds;
    for (const Vec3f& p : cloud.points) bounds.add(p.as<double>());
    auto how = withNameAndVoxel<PointsToDensityOptions>(voxelFor(bounds, options), options);
    how.radius = options.radius.value_or(0);
    std::vector<std::string> notes;
    VdbGrids density = pointsToDensity(cloud, how, notes);
    return finish(std::move(density), in, notes, options);
}

Source readPlySource(const fs::path& in, const ConvertOptions& options) {
    return plyHasFaces(in) ? readMeshSource(in, options) : readPointsSource(in, options);
}

void fillLevelSets(VdbGrids& grids, const ConvertOptions& options) {
    for (openvdb::GridBase::Ptr& grid : grids.grids) {
        if (grid->getGridClass() != openvdb::GRID_LEVEL_SET) continue;
        const std::string name = grid->getName();
        LevelSetToFogOptions how{.band = options.band.value_or(0),
                                 .name = options.name.value_or("density")};
        std::vector<std::string> notes;
        const VdbGrids one{{grid}};
        grid = levelSetToFog(one, how, notes).grids.front();
        for (const std::string& note : notes) say(options.warn, note);
        say(options.info, fmt::format("level set '{}' becomes fog '{}'", name, how.name));
    }
}

}  // namespace woodcock
