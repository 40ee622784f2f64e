// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/choose_camera.h"

#include <gtest/gtest.h>

#include "woodcock/scene/build.h"
#include "woodcock/scene/defaults.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace camera;
using namespace scene;

namespace {

const std::string plank = "[[volume]]\nbox = { min = [0, 0, 0], max = [8, 2, 1] }\nscale = 1\n";

SceneDescription completed(const std::string& text) {
    SceneDescription scene = parseSceneText(text, "scene.toml", ".");
    completeScene(scene, loadScene(scene));
    return scene;
}

SceneDescription orbiting(double degrees, const std::string& camera = "") {
    return completed(plank + "[camera]\n" + camera + fmt::format("orbit = {}\n", degrees));
}

const LookAt& lookAt(const SceneDescription& scene) { return std::get<LookAt>(*scene.camera.pose); }

void expectNear(Vec3d a, Vec3d b, double error = 1e-9) {
    EXPECT_LE(length(a - b), error) << a.x << ", " << a.y << ", " << a.z;
}

TEST(Orbit, TurnsAGivenCameraToItsRightAroundWhatItLooksAt) {
    const std::string camera = "eye = [1, 3, 15]\nlook_at = [1, 2, 5]\n";
    const LookAt turned = lookAt(orbiting(90, camera));
    expectNear(turned.eye, {11, 3, 5});
    expectNear(turned.target, {1, 2, 5});
    expectNear(lookAt(orbiting(-90, camera)).eye, {-9, 3, 5});
    expectNear(lookAt(orbiting(360, camera)).eye, {1, 3, 15});
    expectNear(lookAt(orbiting(90, camera + "up = [0, 0, 1]\n")).eye, {0, 2, 15});
    EXPECT_EQ(lookAt(orbiting(0, camera)), lookAt(completed(plank + "[camera]\n" + camera)));
}

TEST(Orbit, TurnsAMatrixAroundTheMiddleOfWhatIsThere) {
    const std::string camera =
        "matrix = [[1,0,0,4],[0,1,0,1],[0,0,1,20.5],[0,0,0,1]]\n";  // looks at the middle
    const Affine3d pose = worldFromCamera(*orbiting(90, camera).camera.pose);
    expectNear(pose.translation, {24, 1, 0.5});
    expectNear(pose.column[2], {1, 0, 0});
    expectNear(pose.column[1], {0, 1, 0});
}

TEST(Orbit, OfAChosenCameraKeepsItsDistanceAndShowsAllFromEverySide) {
    const Vec3d middle{4, 1, 0.5};
    double distance = 0;
    for (int degrees = 0; degrees < 360; degrees += 15)
        for (const char* type : {"", "type = \"orthographic\"\n"}) {
            const SceneDescription scene = orbiting(degrees, type);
            const Camera camera = buildScene(scene, loadScene(scene)).camera;
            const Affine3d cameraFromWorld = camera.worldFromCamera.inverse();
            const double aspect = double(scene.render.width) / scene.render.height;
            for (int i = 0; i < 8; ++i) {
                const Vec3d p = cameraFromWorld.point(
                    std::get<HomogeneousBox>(scene.volumes[0].coefficients).box.corner(i));
                const double half = camera.kind == Camera::Kind::Orthographic
                                        ? camera.height / 2
                                        : -p.z * std::tan(camera.fovY * pi / 360);
                EXPECT_LT(std::abs(p.x), 0.85 * half * aspect) << degrees << type;
                EXPECT_LT(std::abs(p.y), 0.85 * half) << degrees << type;
            }
            // It turns about the upright axis through the middle, and looks at a point of it.
            const LookAt& pose = lookAt(scene);
            expectNear({pose.target.x, 1, pose.target.z}, middle, 0.01);
            if (*type) continue;
            if (distance == 0) distance = length(pose.eye - pose.target);
            EXPECT_NEAR(length(pose.eye - pose.target), distance, 1e-9);
        }
}

TEST(Orbit, LeavesTheLightsWhereTheyAre) { EXPECT_EQ(orbiting(0).lights, orbiting(120).lights); }

TEST(Orbit, IsDoneInTheSceneThatIsSaved) {
    const SceneDescription turned = orbiting(30);
    EXPECT_EQ(writeScene(turned).find("orbit"), std::string::npos);
    SceneDescription saved =
        parseSceneText(writeScene(turned), "saved.toml", ".", {"camera.orbit=20"});
    completeScene(saved, loadScene(saved));
    expectNear(lookAt(saved).eye, lookAt(orbiting(50)).eye);
}

}  // namespace
}  // namespace woodcock::test
