// SPDX-License-Identifier: Apache-2.0
// What moves by its keys while the shutter is open.
#include "woodcock/scene/movements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/expect_error.h"
#include "woodcock/base/random.h"
#include "woodcock/scene/animation.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace scene;

namespace {

const std::string ball = "[[surface]]\nsphere = {}\n";

SceneDescription parse(const std::string& text) { return parseSceneText(text, "shot.toml", "."); }

}  // namespace

TEST(Movements, WhatCannotMoveInTheShutterIsRefused) {
    const auto build = [](const std::string& text) {
        const SceneDescription scene = parse(text);
        return buildScene(scene, loadScene(scene));
    };
    const std::string camera = "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n",
                      open = camera + "shutter = 0.5\n";
    const std::string lamp =
        ball +
        "[[light]]\ntype = \"sphere\"\nposition = [0, 3, 0]\nradius = { keys = [[0, 1], [4, 2]] "
        "}\n";
    build(lamp + camera);
    expectError(ErrorKind::Input,
                "shot.toml:6:10: light[0] changes its size or form while the shutter is open, and "
                "lights may only move. Let that stay, or set the shutter to 0",
                [&] { build(lamp + open); });
    const std::string glowing =
        ball +
        "material = \"m\"\ntransform = { translate = { keys = [[0, [0, 0, 0]], [1, [1, 0, 0]]] } "
        "}\n[[material]]\nname = \"m\"\ntype = \"emissive\"\n";
    build(glowing + camera);
    expectError(ErrorKind::Input, "surface[0] emits light, and moves while the shutter is open",
                [&] { build(glowing + open); });
}

TEST(Movements, LightsMoveInTheShutter) {
    const auto build = [](const std::string& light, double frame, const std::string& shutter) {
        const SceneDescription scene = atFrame(
            parse(ball + "[[light]]\n" + light +
                  "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\nshutter = " + shutter + "\n"),
            frame);
        return buildScene(scene, loadScene(scene));
    };
    const std::string moves = "position = { keys = [[0, [0, 3, 0]], [4, [2, 3, -1]]] }\n";
    RandomStream random(1);
    const std::vector<std::string> lights{
        "type = \"point\"\nintensity = 3\n" + moves,
        "type = \"sphere\"\nradius = 0.5\n" + moves,
        "type = \"spot\"\nlook_at = [0, 0, 0]\ncone = 170\n" + moves,
        "type = \"spot\"\ncone = 90\nposition = [0, 3, 0]\n"
        "direction = { keys = [[0, [0, -1, 0]], [4, [1, -1, 0]]] }\n",
        "type = \"rectangle\"\nsize = [1, 2]\nlook_at = [0, -5, 0]\n" + moves,
        "type = \"disk\"\ntransform = { rotate = { keys = [[0, [180, 0, 0]], [4, [230, 20, 0]]] }, "
        "translate = [0, 3, 0], scale = [1, 1, 2] }\n"};
    for (const std::string& light : lights) {
        SCOPED_TRACE(light);
        const render::Scene moving = build(light, 2, "2");  // from 1 to 3
        ASSERT_TRUE(moving.lights.moves());
        for (const double u : {0.0, 0.3, 0.5, 0.9, 1.0}) {
            const render::Scene still = build(light, 1 + 2 * u, "0");
            ASSERT_FALSE(still.lights.moves());
            const auto time = static_cast<float>(u);
            EXPECT_LT(length(*moving.lights.position(0, time) - *still.lights.position(0)), 3e-4);
            double most = 0;
            for (int i = 0; i < 50; ++i) {
                const Vec3d from{random.uniform() - 0.5, random.uniform(), random.uniform() - 0.5};
                const double a = random.uniform(), b = random.uniform();
                const light::LightSample s = moving.lights.sample(0, from, a, b, time);
                const light::LightSample t = still.lights.sample(0, from, a, b);
                most = std::max({most, length(s.direction - t.direction),
                                 std::abs(s.distance - t.distance),
                                 std::abs(double{s.weight[0] - t.weight[0]}),
                                 std::abs(moving.lights.pdf(0, from, s.direction, time) -
                                          still.lights.pdf(0, from, t.direction))});
                const light::LightHit hit = moving.lights.meet(0, from, s.direction, time);
                const light::LightHit same = still.lights.meet(0, from, t.direction);
                if (std::isfinite(hit.distance) && std::isfinite(same.distance))
                    most = std::max(most, std::abs(hit.distance - same.distance));
            }
            EXPECT_LT(most, 2e-3);
        }
    }
}

TEST(Movements, MovesInTheShutterOnlyWhatDoes) {
    const auto build = [](const std::string& text) {
        const SceneDescription scene = atFrame(parse(text), 2);
        return buildScene(scene, loadScene(scene));
    };
    const std::string text =
        "[[volume]]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\nsigma_a = 1\n" + ball +
        "transform = { translate = { keys = [[0, [0, 0, 0]], [4, [8, 0, 0]]] } }\n"
        "[camera]\nlook_at = [0, 0, 0]\nfov = { keys = [[0, 30], [2, 30], [4, 40]] }\n"
        "eye = { keys = [[0, [0, 0, 5]], [1.5, [1, 0, 5]]] }\n";
    render::Scene scene = build(text);
    EXPECT_FALSE(scene.camera.motion || scene.surfaces->geometry.moves());
    scene = build(text + "shutter = [-0.25, 0.5]\n");
    ASSERT_TRUE(scene.surfaces->geometry.moves());
    EXPECT_FALSE(scene.medium.parts[0].description().movement);
    const auto& instance = scene.surfaces->geometry.instances()[0];
    EXPECT_EQ(instance.worldFromObject.translation.x, 4);
    EXPECT_NEAR(instance.motion->at(0).translation.x, -0.5, 1e-12);
    EXPECT_NEAR(instance.motion->at(1).translation.x, 1, 1e-12);
    ASSERT_TRUE(scene.camera.motion);
    EXPECT_FALSE(scene.camera.motion->pose);  // its last key has passed
    EXPECT_EQ(scene.camera.at(0.2f).fovY, 30);
    EXPECT_NEAR(scene.camera.at(1).fovY, 32.5, 1e-9);
}

}  // namespace woodcock::test
