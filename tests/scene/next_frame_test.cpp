// SPDX-License-Identifier: Apache-2.0
// Where what a frame shows goes until the next one, and the layer of motion.
#include "woodcock/scene/next_frame.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "woodcock/base/temp_dir.h"
#include "woodcock/proof/support/write_vdb.h"
#include "woodcock/render/session.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/light_groups.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace image;
using namespace scene;

namespace {

constexpr int width = 40, height = 20;

/// The motion that a picture of a scene shows at its middle, in pixels.
std::array<float, 2> motionOf(const std::string& text, const std::filesystem::path& base = ".") {
    const SceneDescription description = parseSceneText(
        text, "scene.toml", base,
        {"output.layers=motion", fmt::format("render.resolution=[{}, {}]", width, height)});
    render::RenderSettings settings = renderSettings(description.render);
    settings.endSample = 4, settings.maxScatterings = 0;
    settings.layers = layerNeeds(description);
    const render::Scene scene = buildScene(description, loadScene(description));
    return render::render(scene, settings).film.motion(width / 2, height / 2);
}

const std::string light = "[[light]]\ntype = \"environment\"\n";
/// Four units high at any distance: five pixels are one unit.
std::string camera(const std::string& keys = "") {
    return "[camera]\ntype = \"orthographic\"\nheight = 4\nlook_at = [0, 0, 0]\n" +
           (keys.empty() ? "eye = [0, 0, 9]\n" : keys);
}
const std::string wall = "[[surface]]\nbox = { min = [-9, -9, -1], max = [9, 9, 0] }\n";
std::string moved(const std::string& what) {
    return what + "transform = { translate = { keys = [[0, [0, 0, 0]], [2, [2, 1, 0]]] } }\n";
}

TEST(NextFrame, WhatStandsStillDoesNotMove) {
    EXPECT_EQ(motionOf(wall + light + camera()), (std::array<float, 2>{0, 0}));
}

/// Half of the way of two frames: a unit to the right and half a unit up, in a picture whose y is
/// down. The shutter has no say in it.
TEST(NextFrame, SurfacesAndVolumesFollowTheirKeys) {
    const std::string box =
        "[[volume]]\nbox = { min = [-9, -9, -1], max = [9, 9, 0] }\nsigma_a = 5\nsigma_s = 0\n";
    for (const std::string& thing : {moved(wall), moved(box)})
        for (const char* shutter : {"", "shutter = 0.01\n"}) {
            const auto motion = motionOf(thing + light + camera() + shutter);
            EXPECT_NEAR(motion[0], 5, 1e-3) << thing << shutter;
            EXPECT_NEAR(motion[1], -2.5, 1e-3) << thing << shutter;
        }
}

TEST(NextFrame, ACameraThatMovesMovesAllTheOtherWay) {
    const auto motion = motionOf(wall + light +
                                 "[camera]\ntype = \"orthographic\"\nheight = 4\n"
                                 "eye = { keys = [[0, [0, 0, 9]], [1, [1, 0, 9]]] }\n"
                                 "look_at = { keys = [[0, [0, 0, 0]], [1, [1, 0, 0]]] }\n");
    EXPECT_NEAR(motion[0], -5, 1e-3);
    EXPECT_NEAR(motion[1], 0, 1e-3);
}

TEST(NextFrame, SmokeGoesOnAsItsVelocitiesSay) {
    const TempDir dir;
    proof::GridSpec density, velocity;
    density.name = "density";
    velocity.name = "vel", velocity.type = proof::VdbType::Vec3s, velocity.gridClass = "unknown";
    density.box = {{-8, -8, -8}, {7, 7, 7}};
    velocity.box = {{-10, -10, -10}, {9, 9, 9}};  // beyond the smoke's soft edge, too
    density.value = [](Vec3i) { return 1.0; };
    velocity.colour = [](Vec3i) { return Vec3d{12, 24, 0}; };  // per second
    proof::writeVdb(dir / "smoke.vdb", {density, velocity});
    const std::string smoke = "[[volume]]\nfile = \"smoke.vdb\"\nscale = 5\nalbedo = 0\n";
    for (const char* shutter : {"", "shutter = 0.01\n"}) {
        const auto motion = motionOf(smoke + light + camera() + shutter, dir.path());
        EXPECT_NEAR(motion[0], 0.5 * 5, 1e-3) << shutter;  // 24 frames in a second
        EXPECT_NEAR(motion[1], -1.0 * 5, 1e-3) << shutter;
    }
}

TEST(NextFrame, IsBuiltOnlyWhereTheLayerIsAskedFor) {
    SceneDescription description = parseSceneText(wall + light + camera(), "scene.toml", ".", {});
    EXPECT_EQ(buildScene(description, loadScene(description)).next, nullptr);
    description.output.layers = {"all"};
    EXPECT_NE(buildScene(description, loadScene(description)).next, nullptr);
}

}  // namespace
}  // namespace woodcock::test
