// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "woodcock/grid/velocity.h"

namespace woodcock::grid {

/// How a grid moves while the shutter is open. Where it is read at an index position x and a time,
/// it holds what its file has at source(x, time): Kim and Ko 2007, "Eulerian Motion Blur", eq. 6
/// and 7. Values are carried along unchanged, not thinned where the matter spreads. Times go from 0
/// where the shutter opens to 1 where it closes.
class Motion {
public:
    /// `open`, `close`: in units of the velocities' time, since the moment that the file shows;
    /// negative: before it.
    /// Throws Error{Input} where something moves by more than 2^30 voxels.
    Motion(std::shared_ptr<const Velocity> velocity, const Affine3d& objectFromIndex, double open,
           double close);

    /// The index position in the file of what is at `index`.
    Vec3d source(Vec3d index, float time) const {
        const double dt = open_ + double{time} * length_;
        const Vec3d first = velocityAt(index) * dt;
        if (first == Vec3d{}) return index;
        return index - velocityAt(index - first) * dt;
    }
    /// A box that holds the sources of all positions in `box`, at all times of the shutter; or at
    /// one.
    Box3d sources(const Box3d& box) const { return sources(box, open_, open_ + length_); }
    Box3d sources(const Box3d& box, float time) const {
        const double dt = open_ + double{time} * length_;
        return sources(box, dt, dt);
    }
    /// The same where the box is so small that its corners tell more than whole voxels do.
    Box3d closeSources(const Box3d& box, float time) const;

    /// A box that holds all positions whose source lies in `box`, but perhaps more.
    Box3d reached(const Box3d& box) const;

    /// False where it only stands at another place than the file shows, for all of the shutter.
    bool moves() const { return length_ != 0; }
    const Velocity& velocity() const { return *velocity_; }
    /// The most voxels by which a point is moved while the shutter is open, from where the file has
    /// it.
    double mostVoxels() const;

private:
    /// A component's lattice, as seen from the moving grid's index space.
    struct Lattice {
        const Field* field = nullptr;
        int channel = 0;
        Affine3d fromIndex;
        double slack = 0;  ///< of positions there, by rounding
    };

    /// In voxels of the moving grid per unit of time.
    Vec3d velocityAt(Vec3d index) const;
    template <class RangeOf>
    Box3d sourcesBy(const Box3d& box, double from, double to, RangeOf rangeOf) const;
    Box3d sources(const Box3d& box, double from, double to) const;
    /// Bounds of the displacement, for velocities from `lower` to `upper`.
    Box3d displacements(const Box3d& velocities, double from, double to) const;

    std::shared_ptr<const Velocity> velocity_;
    Affine3d indexFromObject_;
    std::array<Lattice, 3> lattices_;
    bool together_;  // the components are channels of one field, on one lattice
    double open_, length_;
};

/// The exact range of the trilinear interpolation of one channel over a box of index space that is
/// a few voxels wide, up to rounding: it is extreme at corners of voxel cells and of the box.
Range interpolatedRange(const Field& field, int channel, const Box3d& box);

}  // namespace woodcock::grid
