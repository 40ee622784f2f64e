// SPDX-License-Identifier: Apache-2.0
#include "woodcock/camera/projection.h"

#include <gtest/gtest.h>

namespace woodcock::test {

using namespace camera;

namespace {

std::array<double, 4> rowTimes(Vec3d p, const Matrix44d& m) {
    std::array<double, 4> q{};
    const double from[4] = {p.x, p.y, p.z, 1};
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 4; ++column)
            q[column] += from[row] * m[4 * row + column];
    return q;
}

/// A point of the ray through a pixel comes back to that pixel.
TEST(Projection, InvertsTheCamerasRays) {
    constexpr int width = 60, height = 40;
    for (Camera camera : {Camera::perspective({3, 2, 7}, {0, 1, 0}, {0, 1, 0.2}, 35),
                          Camera::orthographic({3, 2, 7}, {0, 1, 0}, {0, 1, 0}, 5)}) {
        camera.shiftX = 0.2, camera.shiftY = -0.1;
        const Matrix44d ndc = worldToNdc(camera, double(width) / height),
                        toCamera = worldToCamera(camera);
        for (const auto& [x, y] : {std::pair{0.0, 0.0}, {12.5, 33.0}, {60.0, 40.0}})
            for (const double t : {2.0, 9.0}) {
                const CameraRay ray = camera.ray(x, y, width, height);
                const Vec3d p = ray.origin + ray.direction * t;
                const auto q = rowTimes(p, ndc);
                EXPECT_NEAR(q[0] / q[3], x / width, 1e-12);
                EXPECT_NEAR(q[1] / q[3], y / height, 1e-12);
                const Vec3d forward = camera.worldFromCamera.vector({0, 0, -1});
                const double depth = dot(p - camera.worldFromCamera.translation, forward);
                const auto c = rowTimes(p, toCamera);
                EXPECT_NEAR(c[2], depth, 1e-12);
                EXPECT_GT(depth, 0);
                const bool perspective = camera.kind == Camera::Kind::Perspective;
                EXPECT_NEAR(q[2] / q[3], perspective ? 1 - 1 / depth : depth, 1e-12);
            }
    }
}

TEST(Projection, CameraSpaceIsLeftHanded) {
    const Matrix44d m = worldToCamera(Camera::perspective({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 40));
    EXPECT_EQ(rowTimes({1, 2, 3}, m), (std::array<double, 4>{1, 2, 2, 1}));
}

}  // namespace
}  // namespace woodcock::test
