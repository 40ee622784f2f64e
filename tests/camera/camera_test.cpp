// SPDX-License-Identifier: Apache-2.0
#include "woodcock/camera/camera.h"

#include <gtest/gtest.h>

namespace woodcock::test {

using namespace camera;

namespace {

void expectNear(Vec3d a, Vec3d b) {
    EXPECT_LE(length(a - b), 1e-13)
        << a.x << " " << a.y << " " << a.z << ", expected " << b.x << " " << b.y << " " << b.z;
}

TEST(Camera, LooksAlongMinusZThroughTheCentre) {
    const Camera camera;
    const CameraRay ray = camera.ray(32, 18, 64, 36);
    expectNear(ray.origin, {0, 0, 0});
    expectNear(ray.direction, {0, 0, -1});
}

TEST(Camera, CornersOfAPerspectiveLieAtHalfTheFieldOfView) {
    const Camera camera = Camera::perspective({1, 2, 3}, {1, 2, -7}, {0, 1, 0}, 60);
    const double up = std::tan(pi / 6), right = up * 64 / 36;
    expectNear(camera.ray(0, 0, 64, 36).direction, normalize(Vec3d{-right, up, -1}));
    expectNear(camera.ray(64, 0, 64, 36).direction, normalize(Vec3d{right, up, -1}));
    expectNear(camera.ray(64, 36, 64, 36).direction, normalize(Vec3d{right, -up, -1}));
    expectNear(camera.ray(32, 0, 64, 36).origin, {1, 2, 3});
    const Vec3d top = camera.ray(32, 0, 64, 36).direction,
                bottom = camera.ray(32, 36, 64, 36).direction;
    EXPECT_NEAR(std::acos(dot(top, bottom)) * 180 / pi, 60, 1e-10);
}

TEST(Camera, AShiftedFilmShowsWhatLiesBesideIt) {
    const Camera straight = Camera::perspective({1, 2, 3}, {4, 1, -7}, {0, 1, 0}, 60);
    Camera shifted = straight;
    shifted.shiftX = 0.5, shifted.shiftY = -1;
    // Half a height to the right and one down, in pixels of an image 36 high.
    expectNear(shifted.ray(10, 5, 64, 36).direction, straight.ray(28, 41, 64, 36).direction);

    Camera flat = Camera::orthographic({5, 0, 0}, {0, 0, 0}, {0, 0, 1}, 4);
    const CameraRay there = flat.ray(7, 1, 20, 10);
    flat.shiftX = 0.5, flat.shiftY = -1;
    expectNear(flat.ray(2, -9, 20, 10).origin, there.origin);
    expectNear(flat.ray(2, -9, 20, 10).direction, there.direction);
}

TEST(Camera, OrthographicRaysAreParallelAndSpanTheHeight) {
    const Camera camera = Camera::orthographic({5, 0, 0}, {0, 0, 0}, {0, 0, 1}, 4);
    for (double x : {0.0, 10.0, 20.0})
        for (double y : {0.0, 3.0, 10.0}) {
            const CameraRay ray = camera.ray(x, y, 20, 10);
            expectNear(ray.direction, {-1, 0, 0});
            expectNear(ray.origin, {5, (x - 10) * 0.4, 2 - y * 0.4});
        }
}

TEST(Camera, LookAtIsARigidMotion) {
    for (Vec3d eye : {Vec3d{3, -2, 8}, Vec3d{1e7, 1e7, -3}, Vec3d{0, 5e-4, 1e-6}})
        for (Vec3d up : {Vec3d{0, 1, 0}, Vec3d{0.1, -3, 0.2}, Vec3d{1, 0, 0}}) {
            const Vec3d target{0.5, 0.25, -1};
            const Affine3d m = lookAtTransform(eye, target, up);
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t j = 0; j < 3; ++j)
                    EXPECT_NEAR(dot(m.column[i], m.column[j]), i == j, 1e-14);
            EXPECT_NEAR(m.determinant(), 1, 1e-14);
            EXPECT_EQ(m.translation, eye);
            expectNear(m.vector({0, 0, -1}), normalize(target - eye));
            EXPECT_GT(dot(m.column[1], up), 0);
            EXPECT_NEAR(dot(m.column[0], up), 0, 1e-14 * length(up));
        }
}

}  // namespace
}  // namespace woodcock::test
