// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/mesh_to_fog.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tools/ValueTransformer.h>

#include <algorithm>

#include "woodcock/convert/limits.h"
#include "woodcock/convert/openvdb_fog.h"
#include "woodcock/base/error.h"
#include "woodcock/grid/openvdb_grids.h"

namespace woodcock {

namespace {

/// A mesh in index space, as OpenVDB's converter asks for it.
class MeshInVoxels {
public:
    MeshInVoxels(const TriangleMesh& mesh, double voxel) : mesh_(mesh), voxel_(voxel) {}

    std::size_t polygonCount() const { return mesh_.triangles.size(); }
    std::size_t pointCount() const { return mesh_.points.size(); }
    std::size_t vertexCount(std::size_t) const { return 3; }
    void getIndexSpacePoint(std::size_t triangle, std::size_t corner, openvdb::Vec3d& p) const {
        const Vec3d q = mesh_.points[mesh_.triangles[triangle][corner]].as<double>() / voxel_;
        p = {q.x, q.y, q.z};
    }

private:
    const TriangleMesh& mesh_;
    double voxel_;
};

/// Voxels within `reach` voxels of the triangles: of their faces, and around their edges where
/// those are long. Neighbours are counted apart, so that it is rather too many.
double estimateVoxels(const TriangleMesh& mesh, double voxel, double reach) {
    double voxels = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3d p = mesh.points[a].as<double>() / voxel,
                    q = mesh.points[b].as<double>() / voxel,
                    r = mesh.points[c].as<double>() / voxel;
        const double area = length(cross(q - p, r - p)) / 2;
        const double edge = std::max({length(q - p), length(r - q), length(p - r)});
        voxels += 2 * reach * area;
        if (edge > 2 * reach) voxels += edge * pi * reach * reach / 2;
    }
    return voxels;
}

/// Distances in voxels' own world units up to the bands, which are in voxels.
openvdb::FloatGrid::Ptr distances(const TriangleMesh& mesh, double voxel, double outside,
                                  double inside, bool withSign, std::uint64_t mostVoxels) {
    requireVoxel(voxel);
    if (mesh.triangles.empty()) throw inputError("the mesh has no triangles");
    const Box3d box = boundsOf(mesh);
    const double reach = std::max(outside, inside) + 8;
    requireIndices(box.lower / voxel - Vec3d{reach, reach, reach},
                   box.upper / voxel + Vec3d{reach, reach, reach}, voxel);
    requireVoxels(estimateVoxels(mesh, voxel, (outside + inside) / 2 + 0.5), voxel, mostVoxels);
    const auto transform = openvdb::math::Transform::createLinearTransform(voxel);
    return openvdb::tools::meshToVolume<openvdb::FloatGrid>(
        MeshInVoxels(mesh, voxel), *transform, static_cast<float>(outside),
        static_cast<float>(inside), withSign ? 0 : openvdb::tools::UNSIGNED_DISTANCE_FIELD);
}

std::string describe(const OpenEdges& open) {
    return fmt::format(
        "the mesh is open: {} edge{} belong{} to one triangle only (first at {}, {}, {})",
        open.count, open.count == 1 ? "" : "s", open.count == 1 ? "s" : "", open.first.x,
        open.first.y, open.first.z);
}

void noteOpenEdges(const TriangleMesh& mesh, std::vector<std::string>& notes) {
    if (const OpenEdges open = findOpenEdges(mesh); open.count > 0)
        notes.push_back(describe(open) + ", so that it may enclose less than it seems to");
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

VdbGrids named(const openvdb::FloatGrid::Ptr& grid, openvdb::GridClass gridClass,
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

VdbGrids meshToFog(const TriangleMesh& mesh, const MeshToFogOptions& options,
                   std::vector<std::string>& notes) {
    requireVoxel(options.voxel);
    const double band = requireBand(options.band, options.voxel);
    const double bandVoxels = band / options.voxel;
    if (options.shell) {
        const auto grid =
            distances(mesh, options.voxel, bandVoxels + 1, 0, false, options.mostVoxels);
        distanceToShell(*grid, band);
        if (grid->empty())
            throw inputError(
                "no voxel lies within {} of the mesh; take voxels smaller than {}, or a wider band",
                band, options.voxel);
        return named(grid, openvdb::GRID_FOG_VOLUME, options.name);
    }
    // The sign is found outside: one voxel there would do, three are OpenVDB's usual width.
    const auto grid = distances(mesh, options.voxel, 3, bandVoxels + 1, true, options.mostVoxels);
    distancesToFog(*grid, band);
    const OpenEdges open = findOpenEdges(mesh);
    if (grid->empty() && open.count > 0)
        throw inputError("nothing is inside: {}; a shell needs no inside", describe(open));
    if (grid->empty())
        throw inputError(
            "nothing is inside: the mesh is thinner than its voxels; take voxels smaller than {}",
            options.voxel);
    noteOpenEdges(mesh, notes);
    return named(grid, openvdb::GRID_FOG_VOLUME, options.name);
}

VdbGrids meshToLevelSet(const TriangleMesh& mesh, const MeshToLevelSetOptions& options,
                        std::vector<std::string>& notes) {
    requireVoxel(options.voxel);
    const double voxels = requireBand(options.band, options.voxel) / options.voxel + 1;
    const auto grid = distances(mesh, options.voxel, voxels, voxels, true, options.mostVoxels);
    noteOpenEdges(mesh, notes);
    return named(grid, openvdb::GRID_LEVEL_SET, options.name);
}

}  // namespace woodcock
