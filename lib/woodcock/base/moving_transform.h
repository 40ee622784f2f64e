// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/base/polar.h"

namespace woodcock {

/// A transform that changes within the shutter, as a function of a path's time u in [0, 1]. It is
/// made of pieces between which it may jump. On a piece, the rotation turns evenly about one axis,
/// and all else goes straight: see between().
class MovingTransform {
public:
    /// Of any transform: `at(u)` is its value, regular and never mirroring at one time and not at
    /// another. It is smooth between `breaks` (increasing, from 0 to 1); at a break it may jump:
    /// then `at` is its value from there on, and `before(u)` that until there. Turns are even about
    /// `centre`, a point that is moved. There are as many pieces as it takes until the way of
    /// `centre` is right to 1e-4 of its length, and a direction to 1e-5 (radians, or relative
    /// length).
    /// Null where nothing moves.
    static std::shared_ptr<const MovingTransform> follow(
        const std::function<Affine3d(double)>& at, const std::function<Affine3d(double)>& before,
        std::span<const double> breaks, Vec3d centre = {});

    Affine3d at(double u) const;
    /// A box around all images of `box` while it moves.
    Box3d box(const Box3d& box) const { return box_(box, 0, 1); }
    /// Around those from u0 to u1.
    Box3d box(const Box3d& box, double u0, double u1) const { return box_(box, u0, u1); }
    /// How fast a point of `box` moves at most, per unit of u; where the transform jumps, nothing
    /// says.
    double largestSpeed(const Box3d& box) const;
    bool jumps() const { return jumps_; }
    /// The most by which a direction, or a plane's normal, turns away from what it is at time 0, in
    /// radians. Nothing where what is moved is also stretched on its way.
    std::optional<double> largestTurn() const;
    /// It moves along one straight line, evenly, and does not turn.
    bool straight() const { return pieces_.size() == 1 && pieces_[0].shifts; }

private:
    struct Piece {
        double u0, u1;
        Affine3d start;  ///< of points relative to the centre
        PolarMap from, to;
        bool shifts;  ///< it is only translated
    };
    static Affine3d on(const Piece& piece, double s);
    static double speedOf(const Piece& piece, const Box3d& box);
    Box3d box_(const Box3d& box, double u0, double u1) const;

    std::vector<Piece> pieces_;  // without gaps
    Vec3d centre_{};
    bool jumps_ = false;
};

}  // namespace woodcock
