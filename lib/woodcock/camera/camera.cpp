// SPDX-License-Identifier: Apache-2.0
#include "woodcock/camera/camera.h"

#include "woodcock/camera/camera_rays.h"

namespace woodcock::camera {

Camera Camera::at(float time) const {
    Camera camera = *this;
    camera.motion.reset();
    if (!motion) return camera;
    if (motion->pose) camera.worldFromCamera = motion->pose->at(double{time});
    if (motion->lens) {
        const Lens lens = Lens::of(motion->lens->at(double{time}));
        camera.fovY = lens.fovY, camera.height = lens.height;
        camera.shiftX = lens.shiftX, camera.shiftY = lens.shiftY;
    }
    return camera;
}

CameraRay Camera::ray(double x, double y, int pixelWidth, int pixelHeight, float time) const {
    return CameraRays(*this, pixelWidth, pixelHeight).at(x, y, time);
}

Affine3d lookAtTransform(Vec3d eye, Vec3d lookAt, Vec3d up) {
    const Vec3d z = normalize(eye - lookAt);
    const Vec3d x = normalize(cross(up, z));
    return {{x, cross(z, x), z}, eye};
}

Camera Camera::perspective(Vec3d eye, Vec3d lookAt, Vec3d up, double fovY) {
    return {Kind::Perspective, lookAtTransform(eye, lookAt, up), fovY, 1};
}

Camera Camera::orthographic(Vec3d eye, Vec3d lookAt, Vec3d up, double height) {
    return {Kind::Orthographic, lookAtTransform(eye, lookAt, up), 40, height};
}

}  // namespace woodcock::camera
