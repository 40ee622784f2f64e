// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/animation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/expect_error.h"
#include "woodcock/scene/keys/values.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace scene;

namespace {

const std::string ball = "[[surface]]\nsphere = {}\n";

SceneDescription parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
    return parseSceneText(text, "shot.toml", ".", overrides);
}

void expectMistake(const std::string& text, const std::string& message) {
    expectError(ErrorKind::Input, message, [&] { parse(text); });
}

/// Without places, and as read from what writeScene() says.
SceneDescription readBack(const SceneDescription& scene) {
    SceneDescription read = parseSceneText(writeScene(scene), "written.toml", ".");
    read.places.clear();
    return read;
}

Vec3d eyeOf(const SceneDescription& scene) { return std::get<LookAt>(*scene.camera.pose).eye; }

}  // namespace

TEST(Animation, NumbersVectorsAndColoursFollowTheirKeys) {
    const SceneDescription scene = parse(
        "[[volume]]\nfile = \"a.vdb\"\nscale = { keys = [[0, [2, 2, 2]], [10, [4, 6, 8]]] }\n"
        "[[light]]\ntype = \"point\"\nposition = [0, 1, 0]\nintensity = { keys = [[-4, 0], [4, "
        "8]] }\n"
        "[camera]\nlook_at = [0, 0, 0]\neye = { keys = [[0, [0, 0, 4]], [8, [8, 0, 4]]] }\n"
        "fov = { keys = [[0, 30], [4, 50]], interpolation = \"constant\" }\n"
        "[output]\nexposure = { keys = [[0, 0], [2, 1]] }\n");
    EXPECT_EQ(scene.frame, 0);
    const SceneDescription there = atFrame(scene, 2.5);
    EXPECT_EQ(there.frame, 2.5);
    EXPECT_EQ(*std::get<DensityCoefficients>(there.volumes[0].coefficients).scale,
              Rgb(2.5f, 3.0f, 3.5f));
    EXPECT_EQ(std::get<PointDescription>(there.lights[0].light).intensity, Rgb(6.5f));
    EXPECT_EQ(std::get<PointDescription>(scene.lights[0].light).intensity, Rgb(4.0f));
    EXPECT_EQ(eyeOf(there), (Vec3d{2.5, 0, 4}));
    EXPECT_EQ(there.camera.fovY, 30);
    EXPECT_EQ(atFrame(scene, 4).camera.fovY, 50);
    EXPECT_EQ(there.output.exposure, 1);
    EXPECT_EQ(keyFrames(scene), (std::vector<double>{-4, 0, 2, 4, 8, 10}));
    EXPECT_TRUE(isAnimated(scene, "camera"));
    EXPECT_FALSE(isAnimated(scene, "render"));
    EXPECT_EQ(atFrame(atFrame(scene, 7), 2.5), there);
}

TEST(Animation, TransformsFollowTheirComponentsAsTheyAreWritten) {
    const SceneDescription scene = parse(
        ball +
        "[surface.transform]\ntranslate = [1, 2, 3]\nrotate = { keys = [[0, [0, 0, 0]], [10, [0, "
        "720, 30]]] }\nscale = { keys = [[0, 1], [10, 3]] }\n" +
        ball +
        "transform = { keys = [[0, { translate = [1, 0, 0] }], [4, { rotate = [0, 0, 180], scale = "
        "5 }]] }\n" +
        ball +
        "instances = [{ translate = { keys = [[0, [0, 0, 0]], [2, [4, 0, 0]]] } }, { scale = 2 "
        "}]\n");
    for (const double frame : {0.0, 2.5, 6.125, 10.0}) {
        const double s = frame / 10;
        const Affine3d found = atFrame(scene, frame).surfaces[0].worldFromObject;
        const Affine3d expected =
            placement({1, 2, 3}, {0, 720 * s, 30 * s}, Vec3d{1, 1, 1} * (1 + 2 * s));
        EXPECT_EQ(found.translation, expected.translation);
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_LT(length(found.column[c] - expected.column[c]), 1e-14);
    }
    EXPECT_EQ(atFrame(scene, 1).surfaces[1].worldFromObject,
              placement({0.75, 0, 0}, {0, 0, 45}, {2, 2, 2}));
    EXPECT_EQ(atFrame(scene, 1).surfaces[2].instances[0].translation, (Vec3d{2, 0, 0}));
    EXPECT_EQ(atFrame(scene, 1).surfaces[2].instances[1], Affine3d::scale({2, 2, 2}));
}

TEST(Animation, MatricesTurnEvenly) {
    const auto scene = [](const std::string& interpolation) {
        return parse(ball + "matrix = { interpolation = \"" + interpolation +
                     "\", keys = [[0, [[2, 0, 0, 1], [0, 2, 0, 0], [0, 0, 2, 0], [0, 0, 0, 1]]],\n"
                     "[2, [[0, -4, 0, 3], [4, 0, 0, 0], [0, 0, 4, 0], [0, 0, 0, 1]]]] }\n");
    };
    const Affine3d half = placement({2, 0, 0}, {0, 0, 45}, {3, 3, 3});
    for (const char* interpolation : {"linear", "smooth"}) {
        const Affine3d found = atFrame(scene(interpolation), 1).surfaces[0].worldFromObject;
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_LT(length(found.column[c] - half.column[c]), 1e-12) << interpolation;
        EXPECT_LT(length(found.translation - half.translation), 1e-12);
    }
    const Affine3d third = atFrame(scene("linear"), 2.0 / 3).surfaces[0].worldFromObject;
    EXPECT_NEAR(std::atan2(third.column[0].y, third.column[0].x), pi / 6, 1e-12);
    EXPECT_EQ(atFrame(scene("constant"), 1).surfaces[0].worldFromObject.translation.x, 1);
}

TEST(Animation, WhatStandsBesideAKeyIsKept) {
    // Values that the description says in another way.
    SceneDescription scene = parse(
        "[[volume]]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\nscale = { keys = [[0, 2], [4, "
        "4]] }\nalbedo = 0.5\n" +
        ball +
        "material = \"m\"\n[[material]]\nname = \"m\"\ntype = \"diffuse\"\ncolour = { image = "
        "\"sub/a.png\", times = { keys = [[0, 0.5], [4, 1]] } }\n"
        "[[light]]\ntype = \"spot\"\nlook_at = [0, 0, 0]\nposition = { keys = [[0, [0, 1, 0]], "
        "[4, [4, 1, 0]]] }\nintensity = 3\ncone = 40\n"
        "[[light]]\ntype = \"rectangle\"\nsize = [1, 1]\nlook_at = [0, 0, 0]\nup = \"z\"\nposition "
        "= { keys = [[0, [0, 1, 0]], [4, [0, 1, 4]]] }\npower = 2\n"
        "[[light]]\ntype = \"sun\"\nup = \"z\"\nelevation = { keys = [[0, 10], [4, 50]] }\n"
        "[camera]\nfocal_length = { keys = [[0, 20], [4, 60]] }\nsensor_height = 24\n");
    // What was changed since stays.
    scene.volumes[0].g = 0.25f;
    scene.camera.shift = {0.5, 0};
    scene.render.spp = 7;
    const SceneDescription there = atFrame(scene, 2);
    const auto& box = std::get<HomogeneousBox>(there.volumes[0].coefficients);
    EXPECT_EQ(box.sigmaA, Rgb(1.5f));
    EXPECT_EQ(box.sigmaS, Rgb(1.5f));
    EXPECT_EQ(there.volumes[0].g, 0.25f);
    const auto& colour = std::get<DiffuseDescription>(there.materials[0].material).colour;
    EXPECT_EQ(colour.colour, Rgb(0.75f));
    EXPECT_EQ(colour.image, "sub/a.png");
    const auto& spot = std::get<SpotDescription>(there.lights[0].light);
    EXPECT_EQ(spot.position, (Vec3d{2, 1, 0}));
    EXPECT_LT(length(normalize(spot.direction) - normalize(Vec3d{-2, -1, 0})), 1e-15);
    const auto& flat = std::get<RectangleDescription>(there.lights[1].light);
    EXPECT_EQ(flat.worldFromLight.translation, (Vec3d{0, 1, 2}));
    const auto& sun = std::get<SunDescription>(there.lights[2].light);
    EXPECT_EQ(sun.place->elevation, 30);
    EXPECT_EQ(sun.place->up, UpAxis::Z);
    EXPECT_EQ(sun.direction, sun.place->direction());
    EXPECT_NEAR(there.camera.fovY, 2 * std::atan(12.0 / 40) * 180 / pi, 1e-12);
    EXPECT_EQ(there.camera.shift[0], 0.5);
    EXPECT_EQ(there.render.spp, 7);
    // And all of it is written.
    scene.places.clear();
    const SceneDescription read = readBack(scene);
    EXPECT_EQ(read, scene) << writeScene(scene);
    SceneDescription written = atFrame(read, 3), original = atFrame(scene, 3);
    EXPECT_EQ(written, original);
}

TEST(Animation, IsWrittenAndChangesTheDigest) {
    const std::string text =
        ball +
        "[surface.transform]\nrotate = { keys = [[0, [0, 0, 0]], [10, [0, 90, 0]]], interpolation "
        "= \"smooth\" }\n[camera]\neye = { keys = [[0, [0, 0, 5]], [3, [1, 0, 5]]] }\nlook_at = "
        "[0, 0, 0]\n";
    SceneDescription scene = parse(text);
    scene.places.clear();
    const SceneDescription read = readBack(scene);
    EXPECT_EQ(read, scene) << writeScene(scene);
    EXPECT_EQ(sceneDigest(scene), sceneDigest(read));
    EXPECT_NE(sceneDigest(scene), sceneDigest(atFrame(scene, 1)));
    EXPECT_NE(sceneDigest(scene), sceneDigest(parse(text, {"camera.eye.keys[1][0]=4"})));
    SceneDescription again = readBack(atFrame(scene, 2));
    EXPECT_EQ(atFrame(again, 2), atFrame(scene, 2));
}

TEST(Animation, CanBeSetFromOutside) {
    const SceneDescription scene = parse(
        ball,
        {"camera.eye={ keys = [[0, [0, 0, 5]], [4, [4, 0, 5]]] }", "camera.look_at=[0, 0, 0]"});
    EXPECT_EQ(eyeOf(atFrame(scene, 1)), (Vec3d{1, 0, 5}));
    const SceneDescription still =
        parse(ball +
                  "[camera]\nlook_at = [0, 0, 0]\neye = { keys = [[0, [0, 0, 5]], [4, [4, 0, "
                  "5]]] }\n",
              {"camera.eye=[9, 9, 9]"});
    EXPECT_TRUE(still.animation.empty());
}

TEST(Animation, MistakesAreNamedWithTheirPlace) {
    const auto camera = [](const std::string& line) { return ball + "[camera]\n" + line + "\n"; };
    expectMistake(camera("fov = { keys = [[0, 30], [8, 40], [8, 50]] }"),
                  "shot.toml:4:36: camera.fov.keys[2][0] is frame 8; it must come after 8, the "
                  "frame of the key before");
    expectMistake(camera("fov = { keys = [[0, 30], [8, [1, 2, 3]]] }"),
                  "shot.toml:4:30: camera.fov.keys[1][1] is a list of numbers, but the first key "
                  "is a number");
    expectMistake(camera("eye = { keys = [[0, [1, 2, 3]], [8, [1, 2]]] }"),
                  "shot.toml:4:37: camera.eye.keys[1][1] is a list of 2 numbers, but the first key "
                  "is a list of 3 numbers");
    expectMistake(
        camera("fov = { keys = [[0, 30]] }"),
        "shot.toml:4:7: camera.fov has one key, so it does not move; give two or more, or "
        "the value itself");
    expectMistake(camera("fov = { keys = [] }"), "camera.fov has no keys; give two or more");
    expectMistake(camera("fov = { interpolation = \"linear\" }"), "camera.fov has no keys; give");
    expectMistake(camera("fov = { keys = [[0, 30], [1, 40]], interpolation = \"smoth\" }"),
                  "shot.toml:4:52: unknown interpolation 'smoth'; did you mean 'smooth'? known: "
                  "linear, smooth, constant");
    expectMistake(camera("fov = { keys = [[0, 30], [1, 40]], interpolate = \"smooth\" }"),
                  "unknown key 'interpolate' in camera.fov; did you mean 'interpolation'?");
    expectMistake(camera("fov = { keys = [[0, 30], [1, \"x\"]] }"),
                  "camera.fov.keys[1][1] is a string; only numbers, colours");
    expectMistake(camera("fov = { keys = [[0, 30], [24, 200]] }"),
                  "shot.toml:4:31, at frame 24: camera.fov is 200; it must lie strictly between 0 "
                  "and 180");
    expectMistake(camera("orbit = { keys = [[0, 0], [24, 360]] }"),
                  "camera.orbit cannot be animated; of camera, these can: ");
    expectMistake(camera("shutter = { keys = [[0, 0], [24, 1]] }"),
                  "camera.shutter cannot be animated; of camera, these can: ");
    expectMistake(camera("eye = [{ keys = [[0, 0], [24, 1]] }, 0, 5]"),
                  "camera.eye[0] cannot be animated by itself; animate all of camera.eye");
    expectMistake(camera("fof = { keys = [[0, 0], [24, 360]] }"), "unknown key 'fof'");
    expectMistake(ball + "priority = { keys = [[0, 0], [2, 4]] }\n",
                  "surface[0].priority cannot be animated; of surface[0], these can: ");
    expectMistake("[[surface]]\nlathe = { profile = [[{ keys = [[0, 1], [1, 2]] }, 0], [1, 1]] }\n",
                  "surface[0].lathe.profile[0][0] cannot be animated by itself");
    expectMistake(ball + "[render]\nspp = { keys = [[0, 16], [24, 32]] }\n",
                  "shot.toml:4:7: render.spp cannot be animated; what can stands in [[volume]]");
    expectMistake(
        ball + "transform = { scale = { keys = [[0, 1], [2, -1]] } }\n",
        "shot.toml:3:45: surface[0].transform.scale.keys[1][1] scales by -1 where the key "
        "of frame 0 scales by 1; on the way it would be 0");
    expectMistake(ball + "transform = { keys = [[0, {}], [2, { turn = [0, 0, 1] }]] }\n",
                  "unknown key 'turn' in surface[0].transform.keys[1][1], a transform");
    expectMistake(ball +
                      "matrix = { keys = [[0, [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, "
                      "0, 1]]], [1, [[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]]] "
                      "}\n",
                  "mirrors, and the key before does not");
    expectMistake(camera("orbit = 30\nlook_at = [0, 0, 0]\neye = { keys = [[0, [0, 0, 5]], [4, [4, "
                         "0, 5]]] }"),
                  "shot.toml:4:9: camera.orbit cannot be used together with keys of camera.eye");
    // Each key by itself is right, and what lies between is not.
    const SceneDescription through =
        parse(camera("look_at = [0, 0, 0]\neye = { keys = [[0, [0, 0, 5]], [2, [0, 0, -5]]] }"));
    expectError(ErrorKind::Input, "at frame 1: camera.look_at gives no direction to look in",
                [&] { atFrame(through, 1); });
}

}  // namespace woodcock::test
