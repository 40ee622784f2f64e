// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "woodcock/camera/camera.h"

namespace woodcock::camera {

/// Row by row; points are row vectors (x, y, z, 1) that stand before it.
using Matrix44d = std::array<double, 16>;

/// OpenEXR's standard attribute of this name: into a left-handed space with the camera at its
/// origin, +x to the right, +y upwards, +z into the picture.
Matrix44d worldToCamera(const Camera& camera);

/// OpenEXR's standard attribute of this name: after the division by w, (0, 0) is the upper left
/// corner of the picture and (1, 1) the lower right one. `aspect`: its width over its height. Of a
/// perspective camera, z is 1 - 1 / depth; of an orthographic one, the depth.
Matrix44d worldToNdc(const Camera& camera, double aspect);

/// Where a camera without motion sees a point, in pixels of a picture of this size, y down: the
/// inverse of Camera::ray(). Absent behind a perspective camera.
std::optional<std::array<double, 2>> pixelOf(const Camera& camera, Vec3d world, int width,
                                             int height);

}  // namespace woodcock::camera
