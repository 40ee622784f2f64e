// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "woodcock/base/moving_transform.h"

namespace woodcock::camera {

/// The numbers of a camera beside its place; see Camera.
struct Lens {
    double fovY = 40, height = 1, shiftX = 0, shiftY = 0;
    bool operator==(const Lens&) const = default;
};

/// A lens that changes within the shutter: straight between times, or a jump.
class MovingLens {
public:
    /// Of any change: `at` and `before` are as those of MovingTransform::follow(). Straight pieces
    /// differ from it by at most 1e-4 of the whole change. Null where nothing changes.
    static std::shared_ptr<const MovingLens> follow(const std::function<Lens(double)>& at,
                                                    const std::function<Lens(double)>& before,
                                                    std::span<const double> breaks);
    Lens at(double u) const;

private:
    struct Piece {
        double u0, u1;
        Lens from, to;
    };
    std::vector<Piece> pieces_;  // without gaps
};

/// How a camera moves within the shutter, by a path's time from 0 to 1.
struct CameraMotion {
    std::shared_ptr<const MovingTransform> pose;  ///< worldFromCamera; null: it stands still
    std::shared_ptr<const MovingLens> lens;       ///< null: it stays the same
};

}  // namespace woodcock::camera
