// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "woodcock/grid/majorants.h"

namespace woodcock {

/// A ray in a grid's index space; `t` is the world's ray parameter, so that several grids along one
/// world ray share it.
struct IndexRay {
    Vec3d origin, direction;
    Vec3d at(double t) const { return origin + direction * t; }
};

/// Part of a ray inside one majorant cell: lower bound <= field <= upper bound on [t0, t1].
struct Segment {
    double t0, t1;
    Range range;
};

/// Clips [t0, t1] to where the ray is inside `box`; false when nothing is left.
inline bool clip(const IndexRay& ray, const Box3d& box, double& t0, double& t1) {
    for (int i = 0; i < 3; ++i) {
        const double d = ray.direction[i], o = ray.origin[i];
        if (d == 0) {
            if (o < box.lower[i] || o > box.upper[i]) return false;
            continue;
        }
        double a = (box.lower[i] - o) / d, b = (box.upper[i] - o) / d;
        if (a > b) std::swap(a, b);
        t0 = std::max(t0, a), t1 = std::min(t1, b);
    }
    return t0 < t1;
}

/// Steps from cell to cell of a majorant grid along [t0, t1], which must lie inside its field's
/// support: the one traversal below every tracker. Segments are in order and without gaps; which
/// cell comes next is decided in integers, so no step can stall.
class CellWalk {
public:
    CellWalk(const MajorantGrid& majorants, const Box3d& support, const IndexRay& ray, double t0,
             double t1)
        : majorants_(&majorants), ray_(ray), t_(t0), end_(t1) {
        const Vec3d p = ray.at(t0);
        for (int i = 0; i < 3; ++i) {
            inverse_[i] = 1.0 / ray.direction[i];
            low_[i] = static_cast<int>(support.lower[i]), high_[i] = static_cast<int>(support.upper[i]);
            voxel_[i] = floorToInt(std::clamp(p[i], support.lower[i], support.upper[i]));
        }
    }

    /// The next segment; false when the ray has left.
    bool next(Segment& segment) {
        if (!(t_ < end_)) return false;
        const MajorantGrid::Cell cell = majorants_->find(voxel_);
        const int size = 1 << cell.log2Size;
        Vec3i corner;
        double exit = end_;
        int axis = -1;
        for (int i = 0; i < 3; ++i) {
            corner[i] = voxel_[i] & ~(size - 1);
            if (ray_.direction[i] == 0) continue;
            const double face = ray_.direction[i] > 0 ? double{1} * corner[i] + size : corner[i];
            const double t = (face - ray_.origin[i]) * inverse_[i];
            if (t < exit) exit = t, axis = i;
        }
        exit = std::max(exit, t_);
        segment = {t_, exit, cell.range};
        t_ = exit;
        if (axis < 0) {
            t_ = end_;
            return true;
        }
        const Vec3d p = ray_.at(exit);
        for (int i = 0; i < 3; ++i)
            voxel_[i] = std::clamp(floorToInt(p[i]), corner[i], corner[i] + size - 1);
        voxel_[axis] = ray_.direction[axis] > 0 ? corner[axis] + size : corner[axis] - 1;
        if (voxel_[axis] < low_[axis] || voxel_[axis] > high_[axis]) end_ = t_;
        return true;
    }

private:
    const MajorantGrid* majorants_;
    IndexRay ray_;
    Vec3d inverse_;
    Vec3i voxel_, low_, high_;
    double t_, end_;
};

}  // namespace woodcock
