// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/base/affine.h"
#include "woodcock/camera/camera_motion.h"

namespace woodcock::camera {

/// World-space ray with unit direction.
struct CameraRay {
    Vec3d origin, direction;
    float time = 0;  ///< within the shutter: 0 where it opens, 1 where it closes
};

/// Pinhole or orthographic. Looks along -z of camera space, +y up; worldFromCamera is a rigid
/// motion.
struct Camera {
    enum class Kind { Perspective, Orthographic };
    Kind kind = Kind::Perspective;
    Affine3d worldFromCamera;
    double fovY = 40;   ///< full vertical angle in degrees (perspective)
    double height = 1;  ///< world units from bottom to top (orthographic)
    /// How far the film is moved to the right and upwards, in heights of the picture (a lens
    /// shift): the camera sees what lies there without turning.
    double shiftX = 0, shiftY = 0;
    /// How it moves within the shutter: then all of this is as at the frame. Null: it stands still.
    std::shared_ptr<const CameraMotion> motion = {};

    /// As it is at a time within the shutter, and without motion.
    Camera at(float time) const;
    /// The ray through film position (x, y), in pixels of an image of width x height, y down, at a
    /// time within the shutter.
    CameraRay ray(double x, double y, int width, int height, float time = 0) const;

    static Camera perspective(Vec3d eye, Vec3d lookAt, Vec3d up, double fovY);
    static Camera orthographic(Vec3d eye, Vec3d lookAt, Vec3d up, double height);
};

/// worldFromCamera of a camera at `eye` that looks at `lookAt`. `up` is any vector that is not
/// parallel to the view.
Affine3d lookAtTransform(Vec3d eye, Vec3d lookAt, Vec3d up);

}  // namespace woodcock::camera
