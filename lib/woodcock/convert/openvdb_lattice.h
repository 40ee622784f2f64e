// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "woodcock/base/vec.h"
#include "woodcock/grid/vdb/openvdb_transform.h"

namespace woodcock::convert {

/// The lattice of voxels. It goes through the world's origin, and indices count from a voxel near
/// to the object, so that they are small wherever it is. The transform holds the position, in
/// double.
struct Lattice {
    double voxel;
    Vec3d first;  ///< the centre of voxel (0, 0, 0)

    /// `near`: zero, or a point near to the object (originFor()).
    Lattice(Vec3d near, double size) : voxel(size) {
        const Vec3d steps = near / voxel;
        first = Vec3d{std::round(steps.x), std::round(steps.y), std::round(steps.z)} * voxel;
    }
    Vec3d index(Vec3d place) const { return (place - first) / voxel; }
    openvdb::math::Transform::Ptr transform() const {
        return grid::openVdbTransform(Affine3d::translate(first) *
                                      Affine3d::scale({voxel, voxel, voxel}));
    }
};

}  // namespace woodcock::convert
