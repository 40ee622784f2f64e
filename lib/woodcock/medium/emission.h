// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/base/moving_transform.h"
#include "woodcock/base/spectrum.h"
#include "woodcock/grid/cell_walk.h"
#include "woodcock/grid/field.h"
#include "woodcock/grid/majorants.h"

namespace woodcock::grid {
class Motion;
}

namespace woodcock::medium {

/// Takes a point, or a ray, from the world at a time to the world in which what moves is at rest.
/// Out of line: only what moves pays for it.
void moveToRest(const MovingTransform& motion, float time, Vec3d& origin, Vec3d& direction);
void moveToRest(const MovingTransform& motion, float time, Vec3d& point);

/// One additive part of the emission: q(x) = scale x f(x), radiance per world unit of length. It
/// does not depend on absorption. It is zero outside of its field's support or, where the field has
/// a background, outside of the field's limits.
class EmissionPart {
public:
    struct Description {
        std::shared_ptr<const grid::Field>
            field;                ///< 1 or 3 channels; null: 1 inside `box`, 0 outside
        Box3d box;                ///< of object space; only without a field
        Affine3d worldFromIndex;  ///< or world from object, without a field
        Rgb scale{1.0f};          ///< q where f is 1
        std::shared_ptr<const grid::Motion> motion = {};  ///< of the field; null: it stands still
        std::shared_ptr<const MovingTransform> movement = {};  ///< as of MediumPart::Description
        std::uint8_t group = 0;  ///< the number of the light group that it counts to; 0: none
    };
    /// Throws Error{Input} where the transform is singular, the scale negative or infinite, or the
    /// field has a background without limits: a medium that emits everywhere is infinitely bright.
    explicit EmissionPart(Description description);

    const Description& description() const { return d_; }
    /// World box, of the whole shutter.
    Box3d worldBounds() const {
        const Box3d box = d_.worldFromIndex.box(extent_);
        return d_.movement && !extent_.empty() ? d_.movement->box(box) : box;
    }
    /// Index-space box outside of which nothing is emitted, at all times.
    const Box3d& extent() const { return extent_; }
    /// Bounds of the field.
    const grid::MajorantGrid& majorants() const { return majorants_; }
    /// q at a world position and a time within the shutter, by full trilinear interpolation.
    Rgb value(Vec3d world, float time = 0) const;
    /// Calls visit(t0, t1, bound) for the pieces of a ray before tMax where q may differ from 0 at
    /// its time;
    /// no channel of |q| exceeds `bound` there.
    template <class F>
    void walk(Vec3d origin, Vec3d direction, float time, double tMax, F&& visit) const {
        if (d_.movement) moveToRest(*d_.movement, time, origin, direction);
        const grid::IndexRay ray{indexFromWorld_.point(origin), indexFromWorld_.vector(direction)};
        double begin = 0, end = tMax;
        if (extent_.empty() || !grid::clip(ray, extent_, begin, end)) return;
        if (!d_.field) {
            visit(begin, end, largestScale_);
            return;
        }
        double t0 = begin, t1 = end;
        if (support_.empty() || !grid::clip(ray, support_, t0, t1)) t0 = t1 = end;
        const auto piece = [&](double from, double to, double bound) {
            if (bound > 0 && to > from) visit(from, to, bound * largestScale_);
        };
        piece(begin, t0, background_);
        if (!(t0 < t1)) return;
        grid::CellWalk cells(majorants_, support_, ray, t0, t1);
        for (grid::Segment s; cells.next(s);)
            piece(s.t0, s.t1, std::max(std::abs(s.range.min), std::abs(s.range.max)));
        piece(t1, end, background_);
    }

private:
    Description d_;
    Affine3d indexFromWorld_;
    Box3d support_, extent_;
    double background_ = 0;  // its largest channel, within the extent and outside of the support
    double largestScale_ = 0;
    grid::MajorantGrid majorants_;
};

/// A straight piece of a path: world space, direction of unit length.
struct EmissionQuery {
    Vec3d origin, direction;
    float time = 0;  ///< within the shutter: see look_up.h
    double tMax;
    double extinction = 0;  ///< per world unit: of the homogeneous medium that stands for this one
    double u;               ///< in [0, 1)
};

/// A point of a ray, and its emission. The mean of `light` times the transmittance to `t` is the
/// radiance that emission adds to the ray.
struct EmissionPoint {
    double t;
    Rgb light;
    std::uint8_t group;  ///< of the part that it was drawn from, which alone makes the light
};

/// Draws one point on a straight piece of a path in proportion to a bound of the emission there,
/// whether or not the path goes on: Villemin and Hery 2013, "Practical Illumination from Flames";
/// Simon et al. 2017, "Line Integration for Rendering Heterogeneous Emissive Volumes".
///
/// The density is an equal mixture of two. One follows the bounds of q, which keeps every weight
/// bounded. The other also follows the transmittance of a homogeneous medium, so that few points
/// are drawn from where no light gets through.
class EmissionSampler {
public:
    /// Absent where nothing glows along the ray.
    std::optional<EmissionPoint> sample(std::span<const EmissionPart> parts,
                                        const EmissionQuery& q);

private:
    struct Piece {
        const EmissionPart* part;
        double t0, t1, bound;
        double even = 0, dimmed = 0;  ///< integrals of both densities, up to their norms
    };
    std::vector<Piece> pieces_;  // of one ray
};

}  // namespace woodcock::medium
