// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/camera/camera.h"

namespace woodcock::camera {

/// A camera's rays through a picture of one size. What they share is computed once, so this is the
/// quicker way to many of them. The camera must outlive it, and not change.
class CameraRays {
public:
    CameraRays(const Camera& camera, int width, int height);
    /// As Camera::ray().
    CameraRay at(double x, double y, float time = 0) const;

private:
    const Camera* camera_;
    int width_, height_;
    double halfHeight_;  ///< of the picture: in world units, or at depth 1
};

}  // namespace woodcock::camera
