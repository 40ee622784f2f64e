// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "woodcock/render/nested_media.h"

namespace woodcock::render {

/// A ray's way through surfaces, from boundary to boundary. Paths, camera rays for layers and
/// shadow rays go the same way: next() finds what the ray meets, crossing() says what that does to
/// it, and pass() goes on behind it.
class BoundaryWalk {
public:
    BoundaryWalk() = default;  ///< outside of everything
    explicit BoundaryWalk(NestedMedia::RayStart start) : start_(std::move(start)) {}

    /// Looks for the nearest surface of a ray from here; false: there is none.
    bool next(const NestedMedia& media, const SurfaceQuery& ray) {
        meets_ = media.nearest(ray, start_, hit_);
        return meets_;
    }
    /// What next() found.
    bool meets() const { return meets_; }
    const surface::SurfaceHit& hit() const { return hit_; }  ///< only where it meets something
    /// Where the piece ends: at the hit, or at infinity.
    double tMax() const { return meets_ ? hit_.t : std::numeric_limits<double>::infinity(); }
    Crossing crossing(const NestedMedia& media, Vec3d direction) const {
        return media.cross(start_.inside, direction, hit_);
    }

    /// Where the ray is.
    const NestedMedia::RayStart& start() const { return start_; }
    const MediumStack& inside() const { return start_.inside; }
    /// Goes on from the hit, inside of `inside`: Crossing::beyond behind it, Crossing::near for
    /// light that comes back.
    void goOnFromHit(const MediumStack& inside) {
        start_.inside = inside;
        start_.left = hit_;
    }
    void pass(const Crossing& crossing) { goOnFromHit(crossing.beyond); }
    /// Goes on from a point in the medium.
    void leaveSurface() { start_.left.reset(); }

private:
    NestedMedia::RayStart start_;
    surface::SurfaceHit hit_;
    bool meets_ = false;
};

}  // namespace woodcock::render
