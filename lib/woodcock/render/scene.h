// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "woodcock/camera/camera.h"
#include "woodcock/light/light_set.h"
#include "woodcock/medium/medium.h"

namespace woodcock {

/// Everything that light meets: what scene/ builds and the render session draws. Immutable while
/// rendering and shared by all threads.
struct Scene {
    Medium medium;
    LightSet lights;
    Camera camera;
};

}  // namespace woodcock
