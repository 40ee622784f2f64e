// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/mesh_to_fog.h"

#include <openvdb/math/Proximity.h>
#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/ValueTransformer.h>
#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "woodcock/base/error.h"
#include "woodcock/convert/limits.h"
#include "woodcock/convert/mesh_inside.h"
#include "woodcock/convert/openvdb_fog.h"
#include "woodcock/convert/openvdb_lattice.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_transform.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::convert {

namespace {

using Corners = MeshInside::Corners;

/// The lattice of a mesh's voxels.
struct MeshLattice : Lattice {
    MeshLattice(const mesh::TriangleMesh& mesh, double size)
        : Lattice(mesh.origin, size), shift(mesh.origin - first) {}
    Vec3d index(const Vec3f& p) const { return (p.as<double>() + shift) / voxel; }
    std::vector<Vec3d> indices(const mesh::TriangleMesh& mesh) const {
        std::vector<Vec3d> all;
        all.reserve(mesh.points.size());
        for (const Vec3f& p : mesh.points) all.push_back(index(p));
        return all;
    }
    Corners corners(const mesh::TriangleMesh& mesh,
                    const std::array<std::uint32_t, 3>& triangle) const {
        return {index(mesh.points[triangle[0]]), index(mesh.points[triangle[1]]),
                index(mesh.points[triangle[2]])};
    }
    Vec3d shift;  ///< from the first voxel to the mesh's origin
};

/// Triangles in index space, as OpenVDB's converter asks for them.
class TrianglesInVoxels {
public:
    explicit TrianglesInVoxels(const std::vector<Corners>& triangles) : triangles_(triangles) {}

    std::size_t polygonCount() const { return triangles_.size(); }
    std::size_t pointCount() const { return 3 * triangles_.size(); }
    std::size_t vertexCount(std::size_t) const { return 3; }
    void getIndexSpacePoint(std::size_t triangle, std::size_t corner, openvdb::Vec3d& p) const {
        const Vec3d& q = triangles_[triangle][corner];
        p = {q.x, q.y, q.z};
    }

private:
    const std::vector<Corners>& triangles_;
};

/// An estimate of the voxels within `reach` voxels of a triangle: of its face, and around its edges
/// where those are long. Neighbouring triangles are counted separately, so it is rather too high.
double estimateVoxels(const Corners& triangle, double reach) {
    const auto& [p, q, r] = triangle;
    const double area = length(cross(q - p, r - p)) / 2;
    const double edge = std::max({length(q - p), length(r - q), length(p - r)});
    return 2 * reach * area + (edge > 2 * reach ? edge * pi * reach * reach / 2 : 0);
}

/// Checks the limits before anything is made.
void requireRoom(const mesh::TriangleMesh& mesh, const MeshLattice& lattice, double reach,
                 std::uint64_t mostVoxels) {
    if (mesh.triangles.empty()) throw inputError("the mesh has no triangles");
    Box3d box;
    double voxels = 0;
    for (const auto& triangle : mesh.triangles) {
        const Corners corners = lattice.corners(mesh, triangle);
        for (const Vec3d& p : corners) box.add(p);
        voxels += estimateVoxels(corners, reach);
    }
    const double margin = reach + 8;
    requireIndices(box.lower - Vec3d{margin, margin, margin},
                   box.upper + Vec3d{margin, margin, margin}, lattice.voxel);
    requireVoxels(voxels, lattice.voxel, mostVoxels);
}

double distanceTo(const Corners& t, const openvdb::Coord& voxel) {
    const auto vec = [](Vec3d v) { return openvdb::Vec3d(v.x, v.y, v.z); };
    const openvdb::Vec3d p = voxel.asVec3d();
    openvdb::Vec3d weights;
    return (openvdb::math::closestPointOnTriangleToPoint(vec(t[0]), vec(t[1]), vec(t[2]), p,
                                                         weights) -
            p)
        .length();
}

/// Each voxel tries the triangles nearest to its neighbours: at the corners of leaves, OpenVDB's
/// unsigned distances sometimes miss the nearest triangle.
void tryNeighbours(openvdb::FloatGrid& grid, const openvdb::Int32Grid& nearest,
                   const std::vector<Corners>& triangles, double voxel) {
    openvdb::tree::LeafManager<openvdb::FloatTree> leaves(grid.tree());
    leaves.foreach ([&](openvdb::FloatTree::LeafNodeType& leaf, std::size_t) {
        const auto known = nearest.getConstAccessor();
        for (auto value = leaf.beginValueOn(); value; ++value) {
            double best = static_cast<double>(*value) / voxel;
            std::array<int, 27> tried{};
            std::size_t count = 0;
            for (int n = 0; n < 27; ++n) {
                const openvdb::Coord at =
                    value.getCoord().offsetBy(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
                const int t = known.getValue(at);
                const auto end = tried.begin() + static_cast<std::ptrdiff_t>(count);
                if (t < 0 || std::size_t(t) >= triangles.size() ||
                    std::find(tried.begin(), end, t) != end)
                    continue;
                tried[count++] = t;
                best = std::min(
                    best, distanceTo(triangles[static_cast<std::size_t>(t)], value.getCoord()));
            }
            const auto distance = static_cast<float>(best * voxel);
            if (distance < *value) value.setValue(distance);
        }
    });
}

/// Distances (world units) up to `reach` voxels on both sides, without a sign.
openvdb::FloatGrid::Ptr distances(const std::vector<Corners>& triangles, const MeshLattice& lattice,
                                  double reach) {
    const auto uniform = openvdb::math::Transform::createLinearTransform(lattice.voxel);
    const auto nearest = openvdb::Int32Grid::create(-1);
    const auto grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
        TrianglesInVoxels(triangles), *uniform, static_cast<float>(reach), 0,
        openvdb::tools::UNSIGNED_DISTANCE_FIELD, nearest.get());
    tryNeighbours(*grid, *nearest, triangles, lattice.voxel);
    grid->setTransform(lattice.transform());
    return grid;
}

/// The same with OpenVDB's own sign, for meshes without cavities and inner surfaces.
openvdb::FloatGrid::Ptr signedDistances(const MeshInside& inside, const MeshLattice& lattice,
                                        double outside, double within) {
    const auto uniform = openvdb::math::Transform::createLinearTransform(lattice.voxel);
    const std::vector<Corners> triangles = inside.border();
    const auto grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
        TrianglesInVoxels(triangles), *uniform, static_cast<float>(outside),
        static_cast<float>(within));
    grid->setTransform(lattice.transform());
    return grid;
}

bool isSimple(const MeshInside& inside) {
    return inside.cavities() == 0 && inside.nestedSolids() == 0 && !inside.hasInnerSurfaces() &&
           inside.parts() == 1;
}

/// Gives distances their sign: negative inside. Values beyond the band follow.
void sign(openvdb::FloatGrid& grid, const MeshInside& inside) {
    openvdb::tools::foreach (grid.beginValueOn(),
                             [&](const openvdb::FloatGrid::ValueOnIter& value) {
                                 const openvdb::Coord c = value.getCoord();
                                 if (inside.contains({c.x(), c.y(), c.z()}))
                                     value.setValue(-*value);
                             });
    openvdb::tools::signedFloodFill(grid.tree());
}

std::string share(double part) { return fmt::format("{:.2g} %", 100 * part); }

/// Notes what the voxels do not show of a mesh.
void noteInside(const MeshInside& inside, double voxel, std::vector<std::string>& notes) {
    if (inside.nestedSolids() > 0)
        notes.push_back(fmt::format(
            "{} closed part{} of the mesh within others face{} the same way as the outermost part, "
            "and {} taken as solid; for a cavity, turn the faces inwards",
            inside.nestedSolids(), inside.nestedSolids() == 1 ? "" : "s",
            inside.nestedSolids() == 1 ? "s" : "", inside.nestedSolids() == 1 ? "is" : "are"));
    constexpr double few = 0.05, much = 0.3;
    const auto voxels = static_cast<double>(inside.voxels());
    if (inside.missedShare() > few)
        notes.push_back(
            fmt::format("the mesh is thinner than a voxel over {} of its surface, and the fog has "
                        "holes there; take voxels smaller than {:.6g}, or --shell",
                        share(inside.missedShare()), voxel));
    else if (!inside.hasInnerSurfaces() &&
             std::abs(voxels - inside.volume()) > much * inside.volume())
        notes.push_back(fmt::format(
            "the mesh is about as thin as a voxel: it encloses a volume of {:.4g}, and its voxels "
            "one of {:.4g}; take voxels smaller than {:.6g}",
            inside.volume() * std::pow(voxel, 3), voxels * std::pow(voxel, 3), voxel));
}

/// One at the surface, zero at `band` (world units) from it.
void distanceToShell(openvdb::FloatGrid& grid, double band) {
    const auto scale = static_cast<float>(1 / band);
    openvdb::tools::foreach (grid.beginValueOn(),
                             [=](const openvdb::FloatGrid::ValueOnIter& value) {
                                 const float density = 1 - *value * scale;
                                 if (density > 0)
                                     value.setValue(density);
                                 else
                                     value.setValue(0), value.setValueOff();
                             });
    openvdb::tools::changeBackground(grid.tree(), 0.0f);
    openvdb::tools::pruneInactive(grid.tree());
}

grid::VdbGrids named(const openvdb::FloatGrid::Ptr& grid, openvdb::GridClass gridClass,
                     const std::string& name) {
    grid->setGridClass(gridClass);
    grid->setName(name);
    return {{grid}};
}

double requireBand(double band, double voxel) {
    if (!(band >= 0) || !std::isfinite(band))
        throw usageError("a band of {}; it must be positive", band);
    return band > 0 ? band : 3 * voxel;
}

}  // namespace

namespace {

mesh::ClosedMesh closedOrShell(const mesh::TriangleMesh& mesh) {
    try {
        return mesh::closedMesh(mesh);
    } catch (const Error& e) {
        throw Error(e.kind(), fmt::format("{}; so it has no inside. Close the mesh, or use --shell "
                                          "for fog around its surface",
                                          e.what()));
    }
}

}  // namespace

grid::VdbGrids meshToFog(const mesh::TriangleMesh& mesh, const MeshToFogOptions& options,
                         std::vector<std::string>& notes) {
    requireVoxel(options.voxel);
    const double band = requireBand(options.band, options.voxel);
    const MeshLattice lattice(mesh, options.voxel);
    if (options.shell) {
        const double reach = band / options.voxel + 1;
        requireRoom(mesh, lattice, reach, options.mostVoxels);
        std::vector<Corners> triangles;
        for (const auto& triangle : mesh.triangles)
            triangles.push_back(lattice.corners(mesh, triangle));
        const auto grid = distances(triangles, lattice, reach);
        distanceToShell(*grid, band);
        if (grid->empty())
            throw inputError(
                "no voxel lies within {} of the mesh; take voxels smaller than {}, or a wider band",
                band, options.voxel);
        return named(grid, openvdb::GRID_FOG_VOLUME, options.name);
    }
    // No point is deeper than half of the shortest side.
    const Vec3d size = mesh::boundsOf(mesh).size();
    const double deepest = std::min({size.x, size.y, size.z}) / 2;
    const double reach = std::min(band, deepest) / options.voxel + 1;
    requireRoom(mesh, lattice, reach, options.mostVoxels);
    const mesh::ClosedMesh closed = closedOrShell(mesh);
    notes.insert(notes.end(), closed.notes.begin(), closed.notes.end());
    const MeshInside inside(closed, lattice.indices(closed.mesh));
    if (inside.voxels() == 0)
        throw inputError(
            "nothing is inside: the mesh is thinner than its voxels; take voxels smaller than {}",
            options.voxel);
    // The sign needs one voxel outside of the surface; three are OpenVDB's usual width.
    const auto grid = isSimple(inside) ? signedDistances(inside, lattice, 3, reach)
                                       : distances(inside.border(), lattice, reach);
    if (!isSimple(inside)) sign(*grid, inside);
    distancesToFog(*grid, band);
    if (grid->empty())
        throw inputError(
            "nothing is inside: the mesh is thinner than its voxels; take voxels smaller than {}",
            options.voxel);
    noteInside(inside, options.voxel, notes);
    if (const double most = largestValue(*grid); most < 0.999)
        notes.push_back(
            fmt::format("the density is {0:.3g} at most: it reaches one at a depth of {2:.4g} "
                        "(--band), and no voxel lies deeper than {1:.4g} in the mesh",
                        most, most * band, band));
    return named(grid, openvdb::GRID_FOG_VOLUME, options.name);
}

grid::VdbGrids meshToLevelSet(const mesh::TriangleMesh& mesh, const MeshToLevelSetOptions& options,
                              std::vector<std::string>& notes) {
    requireVoxel(options.voxel);
    const double reach = requireBand(options.band, options.voxel) / options.voxel + 1;
    const MeshLattice lattice(mesh, options.voxel);
    requireRoom(mesh, lattice, reach, options.mostVoxels);
    const mesh::ClosedMesh closed = mesh::closedMesh(mesh);
    notes.insert(notes.end(), closed.notes.begin(), closed.notes.end());
    const MeshInside inside(closed, lattice.indices(closed.mesh));
    const auto grid = isSimple(inside) ? signedDistances(inside, lattice, reach, reach)
                                       : distances(inside.border(), lattice, reach);
    if (!isSimple(inside)) sign(*grid, inside);
    noteInside(inside, options.voxel, notes);
    return named(grid, openvdb::GRID_LEVEL_SET, options.name);
}

}  // namespace woodcock::convert
