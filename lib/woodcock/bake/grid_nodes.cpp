// SPDX-License-Identifier: Apache-2.0
// Grids of VDB files, and meshes, as inputs.
#include <cmath>
#include <map>

#include "woodcock/bake/grid_node.h"
#include "woodcock/bake/node_reader.h"
#include "woodcock/bake/openvdb_field.h"
#include "woodcock/convert/mesh_to_fog.h"
#include "woodcock/grid/block_ranges.h"
#include "woodcock/grid/vdb/load_field.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_transform.h"

namespace woodcock::bake {

namespace {

/// A grid's trilinear interpolation. At the positions of its own voxels it gives exactly their
/// values.
class GridNode : public Node {
public:
    GridNode(grid::Field field, const Affine3d& worldFromIndex)
        : field_(std::move(field)),
          indexFromWorld_(worldFromIndex.inverse()),
          ranges_(grid::blockRanges(field_)) {}

    int channels() const override { return field_.channels(); }

    void evaluate(const Points& points, std::span<const Values>,
                  std::span<double* const> out) const override {
        for (std::size_t i = 0; i < points.count; ++i) {
            Vec3d p = field_.nearSupport(indexFromWorld_.point(points[i]));
            for (int a = 0; a < 3; ++a)  // rounding of the inverse transform must not interpolate
                if (const double whole = std::round(p[a]); std::abs(p[a] - whole) < 1e-7)
                    p[a] = whole;
            for (std::size_t c = 0; c < out.size(); ++c)
                out[c][i] = field_.trilinear(p, static_cast<int>(c));
        }
    }

    Bounds bound(const Box3d& box, std::span<const Bounds>) const override {
        Box3d at = indexFromWorld_.box(box);
        at = {at.lower - Vec3d{1, 1, 1} * 1e-6, at.upper + Vec3d{1, 1, 1} * 1e-6};
        const Box3d& support = field_.support();
        Bounds bounds;
        const bool apart = support.empty() || at.upper.x < support.lower.x ||
                           at.upper.y < support.lower.y || at.upper.z < support.lower.z ||
                           at.lower.x > support.upper.x || at.lower.y > support.upper.y ||
                           at.lower.z > support.upper.z;
        if (apart) {
            for (int c = 0; c < 3; ++c)
                bounds[static_cast<std::size_t>(c)] =
                    Interval::of(field_.background(channels() == 3 ? c : 0));
            return bounds;
        }
        const grid::Range range = rangeIn(at);
        bounds.fill({range.min, range.max});
        return bounds;
    }

private:
    grid::Range rangeIn(const Box3d& at) const {
        const Vec3i from = floorToInt(field_.nearSupport(at.lower) * 0.125),
                    to = floorToInt(field_.nearSupport(at.upper) * 0.125);
        constexpr int widest = 4;
        grid::Range range = field_.range();
        for (int c = 0; c < channels(); ++c)
            range.add({field_.background(c), field_.background(c)});
        for (int a = 0; a < 3; ++a)
            if (to[a] - from[a] >= widest) return range;
        range = *ranges_.find(from).value;
        for (int x = from.x; x <= to.x; ++x)
            for (int y = from.y; y <= to.y; ++y)
                for (int z = from.z; z <= to.z; ++z) range.add(*ranges_.find({x, y, z}).value);
        return range;
    }

    grid::Field field_;
    Affine3d indexFromWorld_;
    grid::BlockTable<grid::Range> ranges_;
};

}  // namespace

std::shared_ptr<const Node> gridNode(grid::Field field, const Affine3d& worldFromIndex) {
    return std::make_shared<GridNode>(std::move(field), worldFromIndex);
}

namespace {

Graph::Entry grid(NodeReader& r) {
    const std::filesystem::path file = r.file();
    const std::string name = r.text("grid", "grid = \"density\"");
    grid::LoadOptions options{.storage = grid::Storage::Float, .nonNegative = false};
    const grid::VdbFile listed = grid::listGrids(file);
    for (const grid::GridListing& listing : listed.grids)
        if ((listing.uniqueName == name || listing.name == name) && listing.channels == 3)
            options.use = grid::GridUse::Colour;
    grid::LoadedGrid loaded = grid::loadGrid(file, name, options);
    return {.node = gridNode(std::move(loaded.field), loaded.worldFromIndex)};
}

/// Signed distance to a mesh, from a grid: right up to `band` on both sides, then constant.
Graph::Entry mesh(NodeReader& r) {
    const std::filesystem::path file = r.file();
    const mesh::TriangleMesh triangles = mesh::readMesh(file);
    const Vec3d size = mesh::boundsOf(triangles).size();
    const double longest = std::max({size.x, size.y, size.z});
    convert::MeshToLevelSetOptions options;
    options.voxel = r.number("voxel", longest / 128, positive);
    options.band = r.number("band", 0.1 * longest, positive);
    std::vector<std::string> notes;
    const grid::VdbGrids grids = [&] {
        try {
            return convert::meshToLevelSet(triangles, options, notes);
        } catch (const Error& e) {
            throw r.table().error("{}: {}", file.string(), e.what());
        }
    }();
    const openvdb::GridBase& grid = *grids.grids.front();
    return {.node = gridNode(fieldOf(grid), grid::affineOf(*grid.transform().baseMap()))};
}

constexpr NodeType gridTypes[]{{"grid", grid}, {"mesh", mesh}};

}  // namespace

std::span<const NodeType> gridNodes() { return gridTypes; }

}  // namespace woodcock::bake
