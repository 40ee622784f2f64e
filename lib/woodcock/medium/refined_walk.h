// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/medium/medium.h"

namespace woodcock::medium {

/// A walk whose cells can be cut, while walking, into pieces. A piece has bounds of the
/// reconstruction along that part of the ray. A cell's bounds are those of its voxels. Where one
/// voxel is millions of mean free paths deep, a path that enters where the interpolation begins to
/// rise to it would meet the square root of that many null collisions.
///
/// When to cut may depend on the collisions so far. A Poisson process has no memory, so its rate
/// may be chosen anew at any collision for the rest of the ray.
class RefinedWalk {
public:
    /// `time`: of the ray, within the shutter.
    RefinedWalk(const MediumPart& part, const grid::IndexRay& ray, double tMax, float time = 0)
        : walk_(part, ray, tMax), extinction_(part.largestExtinction()), time_(time) {}

    /// Sets the channels, as bits, that still carry energy. From the next segment or cut on, only
    /// these set the rate of collisions. Otherwise a channel of optical depth 1e12 would set the
    /// rate of all.
    void setLive(const MediumPart& part, unsigned channels) {
        if (channels != live_) {
            live_ = channels, stale_ = true;
            extinction_ = liveExtinction(part);
        }
    }
    /// The largest among live channels. Times range.max of a segment it bounds their sigma_t. Times
    /// (range.max - range.min) it bounds their sigma_t above the segment's control.
    float extinction() const { return extinction_; }

    bool next(const MediumPart& part, const grid::IndexRay& ray, grid::Segment& segment) {
        if (segment.t1 < cell_.t1) {
            segment = piece(part, ray, segment.t1);
            return true;
        }
        collisions_ = 0;
        tight_ = false;
        return walk_.next(segment);
    }

    /// To be called after a collision at `t` in `segment` that the path survived: cuts the segment
    /// there if its bounds are far from tight, or were made for channels that have ended. True if
    /// it did; the segment then starts at `t`.
    bool collided(const MediumPart& part, const grid::IndexRay& ray, double t,
                  grid::Segment& segment) {
        if (tight_ ? !stale_ : ++collisions_ < patience) return false;
        cut(part, ray, t, segment);
        return true;
    }

    /// True where the bounds hold for the reconstruction but not for its voxels: one-tap stochastic
    /// interpolation would exceed them.
    bool tight() const { return tight_; }

private:
    static constexpr int patience = 8;

    float liveExtinction(const MediumPart& part) const;
    void cut(const MediumPart& part, const grid::IndexRay& ray, double t, grid::Segment& segment);
    grid::Segment piece(const MediumPart& part, const grid::IndexRay& ray, double t);

    PartWalk walk_;
    unsigned live_ = 7;  // bits of channels
    float extinction_;   // the largest of them
    float time_;
    bool stale_ = false;            // `live_` has changed since the last cut
    grid::Segment cell_{0, 0, {}};  // that is being cut
    int collisions_ = 0;
    bool tight_ = false;
};

}  // namespace woodcock::medium
