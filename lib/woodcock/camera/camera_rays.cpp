// SPDX-License-Identifier: Apache-2.0
#include "woodcock/camera/camera_rays.h"

#include <cmath>

namespace woodcock::camera {

CameraRays::CameraRays(const Camera& camera, int width, int height)
    : camera_(&camera),
      width_(width),
      height_(height),
      halfHeight_(camera.kind == Camera::Kind::Orthographic ? camera.height / 2
                                                            : std::tan(camera.fovY * pi / 360)) {}

CameraRay CameraRays::at(double x, double y, float time) const {
    if (camera_->motion) return camera_->at(time).ray(x, y, width_, height_, time);
    const Affine3d& worldFromCamera = camera_->worldFromCamera;
    const double h = height_, half = halfHeight_;
    const double sx = (2 * x - width_) / h + 2 * camera_->shiftX;
    const double sy = (h - 2 * y) / h + 2 * camera_->shiftY;  // +-1 at top and bottom, not shifted
    if (camera_->kind == Camera::Kind::Orthographic)
        return {worldFromCamera.point({sx * half, sy * half, 0}),
                normalize(worldFromCamera.vector({0, 0, -1})), time};
    return {worldFromCamera.translation,
            normalize(worldFromCamera.vector({sx * half, sy * half, -1})), time};
}

}  // namespace woodcock::camera
