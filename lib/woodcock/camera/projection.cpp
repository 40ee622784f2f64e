// SPDX-License-Identifier: Apache-2.0
#include "woodcock/camera/projection.h"

#include <cmath>
#include <cstddef>

namespace woodcock::camera {

namespace {

Matrix44d times(const Matrix44d& a, const Matrix44d& b) {
    Matrix44d product{};
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 4; ++column)
            for (std::size_t k = 0; k < 4; ++k)
                product[4 * row + column] += a[4 * row + k] * b[4 * k + column];
    return product;
}

/// The inverse of Camera::ray(), from that left-handed space.
Matrix44d ndcFromCamera(const Camera& camera, double aspect) {
    const double x = -2 * camera.shiftX / aspect + 1, y = 2 * camera.shiftY + 1;
    if (camera.kind == Camera::Kind::Orthographic) {
        const double scale = 1 / camera.height;
        return {scale / aspect, 0, 0, 0, 0, -scale, 0, 0, 0, 0, 1, 0, x / 2, y / 2, 0, 1};
    }
    const double scale = 0.5 / std::tan(camera.fovY * pi / 360);
    return {scale / aspect, 0, 0, 0, 0, -scale, 0, 0, x / 2, y / 2, 1, 1, 0, 0, -1, 0};
}

}  // namespace

Matrix44d worldToCamera(const Camera& camera) {
    const Affine3d m = camera.worldFromCamera.inverse();
    Matrix44d matrix{};
    for (int row = 0; row < 4; ++row) {
        const Vec3d v = row < 3 ? m.column[static_cast<std::size_t>(row)] : m.translation;
        double* to = &matrix[4 * static_cast<std::size_t>(row)];
        to[0] = 0 + v.x, to[1] = 0 + v.y, to[2] = 0 - v.z;  // 0, not -0
        to[3] = row < 3 ? 0 : 1;
    }
    return matrix;
}

Matrix44d worldToNdc(const Camera& camera, double aspect) {
    return times(worldToCamera(camera), ndcFromCamera(camera, aspect));
}

std::optional<std::array<double, 2>> pixelOf(const Camera& camera, Vec3d world, int width,
                                             int height) {
    const Matrix44d ndc = worldToNdc(camera, double(width) / height);
    const std::array<double, 4> from{world.x, world.y, world.z, 1};
    double x = 0, y = 0, w = 0;
    for (std::size_t row = 0; row < 4; ++row) {
        x += from[row] * ndc[4 * row];
        y += from[row] * ndc[4 * row + 1];
        w += from[row] * ndc[4 * row + 3];
    }
    if (!(w > 0)) return std::nullopt;
    return std::array{x / w * width, y / w * height};
}

}  // namespace woodcock::camera
