// SPDX-License-Identifier: Apache-2.0
// What moves by its keys while the shutter is open.
#include "woodcock/scene/movements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

TEST(Movements, LightsMoveAndChangeInTheShutter) {
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
        "translate = [0, 3, 0], scale = [1, 1, 2] }\n",
        "type = \"point\"\nposition = [0, 3, 0]\nintensity = { keys = [[0, 1], [4, 3]] }\n",
        "type = \"sphere\"\npower = 9\nradius = { keys = [[0, 0.1], [4, 0.7]] }\n" + moves,
        "type = \"spot\"\nlook_at = [0, 0, 0]\ncone = { keys = [[0, 30], [4, 120]] }\nblend = { "
        "keys "
        "= [[0, 0.2], [4, 1]] }\n" +
            moves,
        "type = \"rectangle\"\nsize = { keys = [[0, [1, 2]], [4, [3, 1]]] }\npower = 2\n"
        "spread = { keys = [[0, 180], [4, 60]] }\nlook_at = [0, -5, 0]\n" +
            moves,
        "type = \"disk\"\ntransform = { rotate = { keys = [[0, [180, 0, 0]], [4, [230, 20, 0]]] }, "
        "translate = [0, 3, 0], scale = { keys = [[0, [1, 1, 2]], [4, [2, 1, 1]]] } }\n",
        "type = \"sphere\"\nposition = [0, 3, 0]\nradius = { keys = [[0, 0.5], [1.6, 1]], "
        "interpolation = \"constant\" }\n"};
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

TEST(Movements, LightsThatStayThemselvesOnlyMove) {
    const SceneDescription scene = parse(
        ball +
        "[[light]]\ntype = \"rectangle\"\ntransform = { rotate = { keys = [[-1, [0, 0, 0]], [1, "
        "[7, "
        "80, 9]]] }, scale = [0.7, 1, 3] }\n[[light]]\ntype = \"sun\"\nelevation = 40\nirradiance "
        "= { keys = [[-1, "
        "0], [1, 2]] }\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\nshutter = 1\n");
    const Movements moves = findMovements(scene, loadScene(scene));
    EXPECT_TRUE(moves.lights[0].place);
    EXPECT_FALSE(moves.lights[0].form);
    EXPECT_FALSE(moves.lights[1].place || moves.lights[1].form);
}

TEST(Movements, SurfacesThatEmitMoveInTheShutter) {
    const auto build = [](double frame, const std::string& shutter) {
        const SceneDescription scene = atFrame(
            parse(
                ball +
                "[[material]]\nname = \"m\"\ntype = \"emissive\"\nradiance = [1, 2, 3]\n"
                "[[surface]]\nmaterial = \"m\"\nplane = { size = [1, 2] }\ntransform = { rotate = "
                "{ keys = [[0, [180, 0, 0]], [4, [230, 20, 0]]] }, scale = { keys = [[0, [1, 1, "
                "1]], [4, [2, 1, 3]]] }, translate = [0, 3, 0] }\n"
                "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\nshutter = " +
                shutter + "\n"),
            frame);
        return buildScene(scene, loadScene(scene));
    };
    RandomStream random(1);
    const render::Scene moving = build(2, "2");  // from 1 to 3
    ASSERT_TRUE(moving.lights.moves());
    const int mesh = moving.lights.meshIndex();
    for (const double u : {0.0, 0.3, 0.5, 0.9, 1.0}) {
        const render::Scene still = build(1 + 2 * u, "0");
        ASSERT_FALSE(still.lights.moves());
        const auto time = static_cast<float>(u);
        for (int i = 0; i < 50; ++i) {
            const Vec3d from{random.uniform() - 0.5, random.uniform(), random.uniform() - 0.5};
            const double a = random.uniform(), b = random.uniform();
            const light::LightSample s = moving.lights.sample(mesh, from, a, b, time);
            const light::LightSample t = still.lights.sample(mesh, from, a, b);
            ASSERT_EQ(s.emitter, t.emitter);  // both leaves of the tree know their solid angles
            if (s.emitter == light::LightSample::none) continue;
            const Vec3d there = from + s.direction * s.distance;
            EXPECT_LT(length(there - (from + t.direction * t.distance)), 2e-3);
            EXPECT_NEAR(s.pdf / t.pdf, 1, 2e-3);
            EXPECT_NEAR(double{s.weight[1] / t.weight[1]}, 1, 2e-3);
            EXPECT_NEAR(moving.lights.mesh()->pdf(from, s.emitter, there, time) / s.pdf, 1, 1e-9);
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
