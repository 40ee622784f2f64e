// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

#include "woodcock/mesh/closed_mesh.h"

namespace woodcock::convert {

/// Which voxels lie inside a mesh, whose points are given in index space.
///
/// A part that lies in no other is solid, whichever way it faces. A part within others is a cavity
/// if its surroundings are solid and it faces the other way than the outermost part; otherwise it
/// is solid too. Overlapping parts are a union. So a point is inside where it is in more solids
/// than cavities, counted within one outermost part.
class MeshInside {
public:
    using Corners = std::array<Vec3d, 3>;

    /// `points` in voxels, one for each point of the mesh, within the range of indices.
    MeshInside(const mesh::ClosedMesh& mesh, std::vector<Vec3d> points);

    bool contains(Vec3i voxel) const;

    /// The triangles that bound the inside. Where surfaces lie within it, as those of overlapping
    /// parts, triangles are cut into pieces, of an eighth of a voxel at their ends.
    std::vector<Corners> border() const;

    std::size_t voxels() const { return voxels_; }              ///< that are inside
    std::size_t cavities() const { return cavities_; }          ///< parts that are cavities
    std::size_t nestedSolids() const { return nestedSolids_; }  ///< parts within solid parts
    std::size_t parts() const { return adds_.size(); }
    /// Whether parts overlap, or one crosses itself.
    bool hasInnerSurfaces() const { return innerSurfaces_; }
    /// The share of inside pieces of lines along z that hold no voxel's centre.
    double missedShare() const;
    /// The enclosed volume in voxels, where there are no inner surfaces.
    double volume() const { return volume_; }

private:
    /// A triangle that reaches into a slab of width one, by its lower bound in y.
    struct Entry {
        double lower, upper, highest;  ///< its bounds in y; highest: upper bound of all up to here
        std::uint32_t triangle;
    };
    /// Voxels of a column, both included.
    struct Run {
        int y, lower, upper;
    };
    struct Slab {
        int x;
        std::vector<Entry> entries;
        std::vector<Run> runs;  ///< in the order of y and z
    };
    /// Where a line along z meets a triangle; `into` adds to the winding number above.
    struct Crossing {
        int y;
        double z;
        std::uint32_t triangle;
        int into;
        bool operator<(const Crossing& b) const {
            return std::tie(y, z, triangle) < std::tie(b.y, b.z, b.triangle);
        }
    };
    class Around;

    void makeSlabs();
    const Slab* slabAt(int x) const;
    /// How often a triangle winds around the line at x, y, and where it meets it.
    int windsAround(std::uint32_t triangle, double x, double y, double& z) const;
    std::vector<Crossing> crossingsOf(const Slab& slab) const;
    template <class Visit>
    void sweep(const Slab& slab, Visit visit) const;
    void nest();
    template <class Nested>
    bool partsMeet(Nested nested) const;
    void findRuns();
    Around aroundPlace(Vec3d place) const;
    bool isInside(const Around& around) const;
    bool isBorder(const Corners& piece) const;
    /// 1 where all of it is border, 0 where nothing is; -1 for parts, which are added to `kept`.
    int cut(const Corners& piece, std::vector<Corners>& kept) const;

    const mesh::ClosedMesh& mesh_;
    std::vector<Vec3d> points_;
    std::vector<Slab> slabs_;
    std::vector<signed char> adds_;     ///< of each part: 1 a solid, -1 a cavity
    std::vector<std::uint32_t> group_;  ///< of each part: the outermost part around it
    std::size_t voxels_ = 0, cavities_ = 0, nestedSolids_ = 0, pieces_ = 0, missed_ = 0;
    double volume_ = 0;
    bool innerSurfaces_ = false;
};

}  // namespace woodcock::convert
