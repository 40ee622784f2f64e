// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "woodcock/grid/majorants.h"

namespace woodcock::grid {

/// A ray in a grid's index space. Its parameter `t` is that of the ray in the world, so that
/// several grids along one ray share it.
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
        const double a = (box.lower[i] - o) / d, b = (box.upper[i] - o) / d;
        t0 = std::max(t0, std::min(a, b)), t1 = std::min(t1, std::max(a, b));
    }
    return t0 < t1;
}

/// Steps from cell to cell of a majorant grid along [t0, t1], which must lie inside its field's
/// support. Every tracker uses this traversal. Segments are in order and without gaps. The next
/// cell is chosen in integers, so no step can stall.
class CellWalk {
public:
    CellWalk() = default;  ///< walks nothing
    CellWalk(const MajorantGrid& majorants, const Box3d& support, const IndexRay& ray, double t0,
             double t1)
        : majorants_(&majorants), ray_(ray), t_(t0), end_(t1) {
        for (int i = 0; i < 3; ++i) {
            const double d = ray.direction[i];
            const bool still = std::abs(d) < 1e-290;  // its inverse might not be finite
            if (still) ray_.direction[i] = 0;         // never meets the face ahead: 0 x inf is NaN
            forward_[i] = still || d > 0;
            inverse_[i] = still ? std::numeric_limits<double>::infinity() : 1 / d;
            low_[i] = static_cast<int>(support.lower[i]),
            high_[i] = static_cast<int>(support.upper[i]);
            const double p = ray_.at(t0)[i];
            voxel_[i] = floorToInt(std::clamp(p, support.lower[i], support.upper[i]));
        }
    }

    /// The next segment; false when the ray has left.
    bool next(Segment& segment) {
        if (!(t_ < end_)) return false;
        const MajorantGrid::Cell cell = majorants_->find(voxel_);
        const int size = 1 << cell.log2Size;
        const Vec3i corner{voxel_.x & -size, voxel_.y & -size, voxel_.z & -size};
        // Ray parameters of the faces ahead. Without branches: which face is first cannot be
        // predicted.
        const double tx = (corner.x + double(forward_.x) * size - ray_.origin.x) * inverse_.x;
        const double ty = (corner.y + double(forward_.y) * size - ray_.origin.y) * inverse_.y;
        const double tz = (corner.z + double(forward_.z) * size - ray_.origin.z) * inverse_.z;
        const double face = std::min(tx, std::min(ty, tz));
        const double exit = std::max(t_, std::min(face, end_));
        segment = {t_, exit, cell.range};
        t_ = exit;
        if (face >= end_) {
            t_ = end_;
            return true;
        }
        const bool alongX = tx == face, alongY = !alongX && ty == face, alongZ = !alongX && !alongY;
        const Vec3d p = ray_.at(exit);
        // In the other axes, a position that rounding put below the support must not count as
        // outside.
        const auto enter = [size](bool along, int forward, int from, int low, double at) {
            const int across = std::clamp(floorToInt(at), std::max(from, low), from + size - 1);
            return along ? from + (forward ? size : -1) : across;
        };
        voxel_ = {enter(alongX, forward_.x, corner.x, low_.x, p.x),
                  enter(alongY, forward_.y, corner.y, low_.y, p.y),
                  enter(alongZ, forward_.z, corner.z, low_.z, p.z)};
        if (std::min({voxel_.x - low_.x, voxel_.y - low_.y, voxel_.z - low_.z, high_.x - voxel_.x,
                      high_.y - voxel_.y, high_.z - voxel_.z}) < 0)
            end_ = t_;
        return true;
    }

private:
    const MajorantGrid* majorants_ = nullptr;
    IndexRay ray_;
    Vec3d inverse_;
    Vec3i voxel_, low_, high_, forward_;
    double t_ = 0, end_ = 0;
};

}  // namespace woodcock::grid
