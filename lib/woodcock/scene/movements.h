// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "woodcock/base/moving_transform.h"
#include "woodcock/camera/camera_motion.h"
#include "woodcock/light/light_set.h"
#include "woodcock/scene/description.h"
#include "woodcock/scene/load.h"

namespace woodcock::scene {

/// What moves by its keys while the shutter is open, and how local lights change. Null, and empty:
/// it stands still. All else (colours, coefficients, what surfaces emit, what is infinitely far
/// away) stays as it is at the frame.
struct Movements {
    /// From where a thing is at the frame to where it is at a time, in world space. Things that
    /// have the same keys move as one, to the last digit.
    using Movement = std::shared_ptr<const MovingTransform>;
    std::vector<Movement> volumes;                ///< of each
    std::vector<std::vector<Movement>> surfaces;  ///< of each, for each of its instances; or none
    std::vector<light::LightMotion> lights;       ///< of each
    std::shared_ptr<const camera::CameraMotion> camera;
};

/// By the description's shutter.
Movements findMovements(const SceneDescription& description, const LoadedScene& loaded);

}  // namespace woodcock::scene
