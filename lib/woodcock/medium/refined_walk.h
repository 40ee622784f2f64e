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
        : walk_(part, ray, tMax), extinction_(part.largestExtinction()) {}

    /// Names the channels, by their bits, that still carry something: the others set no pace from
    /// the next segment or cut on. (Else a channel of optical depth 1e12 would set that of all.)
    void setLive(const MediumPart& part, unsigned channels) {
        if (channels != live_) {
            live_ = channels, stale_ = true;
            extinction_ = liveExtinction(part);
        }
    }
    /// The largest among live channels. Times range.max of a segment it bounds their sigma_t, and
    /// times what range.max is above range.min it bounds what their sigma_t are above its control.
    float extinction() const { return extinction_; }

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
    /// there, once it has shown to be far from tight, or where its bounds were made for channels
    /// that have died. True when it did: the segment then starts at `t`.
    bool collided(const MediumPart& part, const IndexRay& ray, double t, Segment& segment) {
        if (tight_ ? !stale_ : ++collisions_ < patience) return false;
        cut(part, ray, t, segment);
        return true;
    }

    /// The bounds hold for the reconstruction, but not for the voxels that it is made of: one-tap
    /// stochastic interpolation would break them.
    bool tight() const { return tight_; }

private:
    static constexpr int patience = 8;

    float liveExtinction(const MediumPart& part) const;
    void cut(const MediumPart& part, const IndexRay& ray, double t, Segment& segment);
    Segment piece(const MediumPart& part, const IndexRay& ray, double t);

    PartWalk walk_;
    unsigned live_ = 7;       // bits of channels
    float extinction_;        // the largest of them
    bool stale_ = false;      // `live_` has changed since the last cut
    Segment cell_{0, 0, {}};  // that is being cut
    int collisions_ = 0;
    bool tight_ = false;
};

}  // namespace woodcock
