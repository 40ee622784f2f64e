// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "woodcock/base/moving_numbers.h"
#include "woodcock/base/moving_transform.h"

namespace woodcock::camera {

/// The numbers of a camera beside its place; see Camera.
struct Lens {
    double fovY = 40, height = 1, shiftX = 0, shiftY = 0;

    std::array<double, 4> numbers() const { return {fovY, height, shiftX, shiftY}; }
    static Lens of(const std::array<double, 4>& n) { return {n[0], n[1], n[2], n[3]}; }
};

/// A lens that changes within the shutter, by its numbers().
using MovingLens = MovingNumbers<4>;

/// How a camera moves within the shutter, by a path's time from 0 to 1.
struct CameraMotion {
    std::shared_ptr<const MovingTransform> pose;  ///< worldFromCamera; null: it stands still
    std::shared_ptr<const MovingLens> lens;       ///< null: it stays the same
};

}  // namespace woodcock::camera
