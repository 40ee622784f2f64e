// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "woodcock/base/error.h"
#include "woodcock/convert/level_set_to_fog.h"
#include "woodcock/convert/mesh_to_fog.h"
#include "woodcock/convert/openvdb_convert_source.h"
#include "woodcock/convert/point_grid_read.h"
#include "woodcock/convert/points_to_density.h"
#include "woodcock/grid/vdb/openvdb_transform.h"
#include "woodcock/mesh/ply_file.h"

namespace woodcock::convert {

namespace fs = std::filesystem;

namespace {

constexpr int usualResolution = 256;

/// The size of voxels: that of --voxel, else a fraction of the longest side.
double voxelFor(const Box3d& bounds, const ConvertOptions& options) {
    if (options.placement.size || options.placement.sizeSides || options.placement.origin)
        throw usageError(
            "--size and --origin are for volumes on a lattice; a mesh or points keep their place");
    if (options.placement.voxelSides)
        throw usageError("--voxel takes one number for meshes and points: their voxels are cubes");
    if (options.placement.voxel) return *options.placement.voxel;
    const Vec3d size = bounds.size();
    const double longest = std::max({size.x, size.y, size.z});
    if (!(longest > 0)) throw usageError("all points coincide: give the size of voxels by --voxel");
    const double voxel = longest / usualResolution;
    say(options.info, fmt::format("voxels of {:.4g}: {} along the longest side; see --voxel", voxel,
                                  usualResolution));
    return voxel;
}

/// Warns where coordinates are floats so far from the origin that their steps are coarse beside
/// voxels.
template <class PlaceOf>
void noteFloats(std::size_t count, PlaceOf placeOf, double voxel, const ConvertOptions& options) {
    double furthest = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3d p = placeOf(i);
        for (int a = 0; a < 3; ++a) {
            if (static_cast<double>(static_cast<float>(p[a])) != p[a]) return;
            furthest = std::max(furthest, std::abs(p[a]));
        }
    }
    const auto from = static_cast<float>(furthest);
    const double apart =
        static_cast<double>(std::nextafter(from, std::numeric_limits<float>::infinity()) - from);
    if (apart > voxel / 8)
        say(options.warn,
            fmt::format("the coordinates are floats. Near {:.9g} floats are {:.3g} apart, and "
                        "voxels are {:.3g} wide, so the shape becomes rough or layered. Write "
                        "doubles or text, or move the shape nearer to the origin",
                        furthest, apart, voxel));
}

/// Runs `make`, and adds the file's name to its input errors.
template <class Make>
grid::VdbGrids made(const fs::path& in, Make make) {
    try {
        return make();
    } catch (const Error& e) {
        if (e.kind() != ErrorKind::Input) throw;
        throw inputError("{}: {}", in.string(), e.what());
    }
}

/// Turns and remaps grids as the options say.
Source finish(grid::VdbGrids grids, const fs::path& in, const std::vector<std::string>& notes,
              const ConvertOptions& options) {
    for (const std::string& note : notes) say(options.warn, note);
    Source source{std::move(grids), {}};
    for (const openvdb::GridBase::Ptr& grid : source.grids.grids) {
        if (options.axes.identity()) continue;
        grid->setTransform(grid::openVdbTransform(options.axes.map() *
                                                  grid::affineOf(*grid->transform().baseMap())));
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
    const mesh::TriangleMesh mesh = mesh::readMesh(in);
    say(options.info, fmt::format("read {}: {} triangles, {} points", in.string(),
                                  mesh.triangles.size(), mesh.points.size()));
    auto how = withNameAndVoxel<MeshToFogOptions>(voxelFor(mesh::boundsOf(mesh), options), options);
    how.band = options.band.value_or(0);
    how.shell = options.shell;
    noteFloats(
        mesh.points.size(),
        [&](std::size_t i) { return mesh.origin + mesh.points[i].as<double>(); }, how.voxel,
        options);
    std::vector<std::string> notes;
    grid::VdbGrids fog = made(in, [&] { return meshToFog(mesh, how, notes); });
    return finish(std::move(fog), in, notes, options);
}

Source readPointsSource(const fs::path& in, const ConvertOptions& options) {
    const PointCloud cloud = readPoints(in, options.columns);
    say(options.info,
        fmt::format("read {}: {} points; {}", in.string(), cloud.points.size(), cloud.columns));
    for (const std::string& note : cloud.notes) say(options.warn, note);
    Box3d bounds;
    for (const Vec3d& p : cloud.points) bounds.add(p);
    auto how = withNameAndVoxel<PointsToDensityOptions>(voxelFor(bounds, options), options);
    how.radius = options.radius.value_or(0);
    noteFloats(
        cloud.points.size(), [&](std::size_t i) { return cloud.points[i]; }, how.voxel, options);
    std::vector<std::string> notes;
    grid::VdbGrids density = made(in, [&] { return pointsToDensity(cloud, how, notes); });
    return finish(std::move(density), in, notes, options);
}

Source readPlySource(const fs::path& in, const ConvertOptions& options) {
    return mesh::plyHasFaces(in) ? readMeshSource(in, options) : readPointsSource(in, options);
}

namespace {

bool isLevelSet(const openvdb::GridBase::Ptr& grid) {
    return grid->getGridClass() == openvdb::GRID_LEVEL_SET;
}

/// The name of a level set's fog. The only level set of a file becomes "density", where no grid has
/// that name. Others keep their names, and never take that of another grid.
std::string fogName(const grid::VdbGrids& grids, std::size_t index, const ConvertOptions& options) {
    const auto& all = grids.grids;
    if (options.name && all.size() == 1) return *options.name;
    const auto taken = [&](const std::string& name) {
        for (std::size_t i = 0; i < all.size(); ++i)
            if (i != index && all[i]->getName() == name) return true;
        return false;
    };
    const bool only = std::count_if(all.begin(), all.end(), isLevelSet) == 1;
    if (only && !taken("density")) return "density";
    const std::string own = all[index]->getName().empty() ? "fog" : all[index]->getName();
    std::string name = own;
    for (int n = 1; taken(name); ++n)
        name = fmt::format("{}_fog{}", own, n == 1 ? "" : fmt::to_string(n));
    return name;
}

}  // namespace

bool addPointGrid(grid::VdbGrids& grids, const grid::VdbFile& file, const grid::GridListing& points,
                  const ConvertOptions& options) {
    if (options.placement.size || options.placement.origin || options.channel)
        throw usageError(
            "--size, --origin and --channel are for volumes on a lattice; points keep their place");
    const PointCloud cloud = readPointGrid(file, points);
    if (cloud.points.empty()) {
        say(options.warn, fmt::format("grid '{}' of {} is left out: it holds no points",
                                      points.uniqueName, file.path.string()));
        return false;
    }
    const Vec3d sides = points.voxelSize;
    PointsToDensityOptions how;
    how.voxel = options.placement.voxel.value_or(std::min({sides.x, sides.y, sides.z}));
    how.radius = options.radius.value_or(0);
    const auto taken = [&](const std::string& name) {
        return std::any_of(grids.grids.begin(), grids.grids.end(),
                           [&](const auto& grid) { return grid->getName() == name; });
    };
    if (taken(how.name)) how.name = points.name.empty() ? "points" : points.name;
    for (int n = 2; taken(how.name); ++n) how.name = fmt::format("points_{}", n);
    say(options.info,
        fmt::format("read '{}' from {}: {} points; {}; they become '{}', voxels of {:.4g}",
                    points.uniqueName, file.path.string(), cloud.points.size(), cloud.columns,
                    how.name, how.voxel));
    std::vector<std::string> notes;
    const grid::VdbGrids density =
        made(file.path, [&] { return pointsToDensity(cloud, how, notes); });
    for (const std::string& note : notes) say(options.warn, note);
    grids.grids.push_back(density.grids.front());
    return true;
}

void fillLevelSets(grid::VdbGrids& grids, const ConvertOptions& options) {
    // All names first: each depends on the others, and a converted grid is no longer a level set.
    std::vector<std::string> before, names;
    for (std::size_t i = 0; i < grids.grids.size(); ++i) {
        openvdb::GridBase& grid = *grids.grids[i];
        before.push_back(grid.getName());
        names.push_back(isLevelSet(grids.grids[i]) ? fogName(grids, i, options) : before.back());
        grid.setName(names.back());
    }
    for (std::size_t i = 0; i < grids.grids.size(); ++i) {
        openvdb::GridBase::Ptr& grid = grids.grids[i];
        if (!isLevelSet(grid)) continue;
        const std::string& name = before[i];
        grid->setName(name);
        const LevelSetToFogOptions how{.band = options.band.value_or(0), .name = names[i]};
        std::vector<std::string> notes;
        const grid::VdbGrids one{{grid}};
        grid = levelSetToFog(one, how, notes).grids.front();
        for (const std::string& note : notes) say(options.warn, note);
        say(options.info, fmt::format("level set '{}' becomes fog '{}'", name, how.name));
    }
}

}  // namespace woodcock::convert
