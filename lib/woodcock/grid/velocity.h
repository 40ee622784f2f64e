// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "woodcock/base/affine.h"
#include "woodcock/grid/range_tree.h"

namespace woodcock::grid {

/// The velocities of a volume, in its object space (that of its file) per unit of time. Each
/// component is read by trilinear interpolation on a lattice of its own: staggered voxels hold it
/// on three kinds of faces. Beyond its voxels it is the grid's background.
class Velocity {
public:
    /// One component: a channel of a field.
    struct Source {
        std::shared_ptr<const Field> field;
        int channel = 0;
        Affine3d objectFromIndex;  ///< the grid's own transform
        /// The component's place in a voxel, in index space: half a voxel below its own axis for
        /// staggered ones.
        Vec3d offset{};
    };
    explicit Velocity(std::array<Source, 3> sources);

    const Source& source(int component) const { return sources_[index(component)]; }
    /// Bounds of a component over boxes of its grid's voxels.
    const RangeTree& ranges(int component) const { return *ranges_[index(component)]; }
    Vec3d background() const;
    /// True where it is 0 everywhere.
    bool still() const;
    /// Box of object space outside of which it is background().
    Box3d support() const;

    struct Fastest {
        Vec3d velocity;
        Vec3i voxel{};  ///< of the grids, as their voxels are numbered
    };
    const Fastest& fastest() const { return fastest_; }

private:
    Fastest findFastest() const;
    static std::size_t index(int component) { return static_cast<std::size_t>(component); }

    std::array<Source, 3> sources_;
    std::array<std::shared_ptr<const RangeTree>, 3> ranges_;
    Fastest fastest_;
};

}  // namespace woodcock::grid
