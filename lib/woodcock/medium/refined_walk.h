// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/medium/medium.h"

namespace woodcock {

/// A walk whose cells can be cut, while walking, into pieces with bounds of the reconstruction on
/// that very stretch of the ray. A cell's bounds are those of its voxels: where a single voxel
/// width is millions of mean free paths deep, a path that enters through the foot of the ramp to
/// such a voxel would meet the square root of that many null collisions.
///
/// When to cut may depend on what was met so far: a Poisson process has no memory, so its rate may
/// be chosen anew at any collision for what lies ahead.
class RefinedWalk {
public:
    RefinedWalk(const MediumPart& part, const IndexRay& ray, double tMax)
        : walk_(part, ray, tMax) {}

    bool next(const MediumPart& part, const IndexRay& ray, Segment& segment) {
        if (segment.t1 < cell_.t1) {
            segment = piece(part, ray, segment.t1);
            return true;
        }
        collisions_ = 0;
        tight_ = false;
        return walk_.next(segment);
    }

    /// To be called after a collision at `t` in `segment` that the path survived: cuts the segment
    /// there, once it has shown to be far from tight. True when it did.
    bool collided(const MediumPart& part, const IndexRay& ray, double t, Segment& segment) {
        return ++collisions_ >= patience && cut(part, ray, t, segment);
    }

    /// The bounds hold for the reconstruction, but not for the voxels that it is made of: one-tap
    /// stochastic interpolation would break them.
    bool tight() const { return tight_; }

private:
    static constexpr int patience = 8;

    bool cut(const MediumPart& part, const IndexRay& ray, double t, Segment& segment);
    Segment piece(const MediumPart& part, const IndexRay& ray, double t);

    PartWalk walk_;
    Segment cell_{0, 0, {}};  // that is being cut
    int collisions_ = 0;
    bool tight_ = false;
};

}  // namespace woodcock
