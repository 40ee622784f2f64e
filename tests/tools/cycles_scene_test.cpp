// SPDX-License-Identifier: Apache-2.0
#include "tools/cycles/scene.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/expect_error.h"
#include "tests/tools/fog_scene.h"
#include "tools/cycles/lights.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/image/read_image.h"
#include "woodcock/proof/support/write_vdb.h"
#include "woodcock/scene/defaults.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace proof;
using namespace scene;

namespace {

/// What the scene for Cycles is made of.
nlohmann::json written(const std::string& text) {
    SceneDescription scene = parseSceneText(text, "test.toml", "");
    const LoadedScene loaded = loadScene(scene);
    completeScene(scene, loaded);
    return nlohmann::json::parse(tool::cyclesScene(scene, loaded, {}));
}

TEST(CyclesScene, ScatteringsBecomeBounces) {
    const std::string fog = fogScene();
    EXPECT_EQ(written(fog)["render"]["bounces"]["volume"], 1024);
    EXPECT_EQ(written(fog + "max_scatterings = 5\n")["render"]["bounces"]["volume"], 4);
    // Those off surfaces are bounded together only where nothing else bounces.
    const std::string bounded = fog + "max_bounces = 3\n";
    EXPECT_EQ(written(bounded)["render"]["bounces"]["surface"], 1024);
    const std::string floor = "[[surface]]\nplane = { size = [4, 4] }\n";
    EXPECT_EQ(written(bounded + floor)["render"]["bounces"]["surface"], 2);
    EXPECT_EQ(written(bounded + floor)["render"]["bounces"]["all"], 1024);
    const std::string empty = bounded.substr(bounded.find("[[light]]"));
    EXPECT_EQ(written(empty + floor)["render"]["bounces"]["all"], 2);
    // Without any, what would scatter is lost.
    const auto none = written(fog + "max_scatterings = 0\n")["volumes"][0];
    EXPECT_FALSE(none["scatters"]);
    EXPECT_EQ(none["density"], 1.5);
    EXPECT_EQ(none["sigma_s"], (std::vector<float>{0, 0, 0}));
    EXPECT_EQ(none["sigma_a"][0], 1.5);
    EXPECT_EQ(none["absorb_colour"], (std::vector<float>{0, 0, 0}));
}

/// Whose sockets are those of Blender's nodes that scatter.
TEST(CyclesScene, PhaseFunctionsBecomeThoseOfCycles) {
    const auto phase = [](const std::string& keys) {
        std::string fog = fogScene();
        fog.replace(fog.find("g = 0.3"), 7, keys);
        return written(fog)["volumes"][0]["phase"];
    };
    const auto made = [](const char* text) { return nlohmann::json::parse(text); };
    EXPECT_EQ(phase("g = 0.25"), made(R"({"type": "", "inputs": {"Anisotropy": 0.25}})"));
    EXPECT_EQ(phase("phase = { type = \"isotropic\" }"),
              made(R"({"type": "", "inputs": {"Anisotropy": 0.0}})"));
    EXPECT_EQ(phase("phase = { type = \"henyey_greenstein\", g = 0.5 }"),
              made(R"({"type": "", "inputs": {"Anisotropy": 0.5}})"));
    EXPECT_EQ(phase("phase = { type = \"rayleigh\" }"),
              made(R"({"type": "RAYLEIGH", "inputs": {}})"));
    EXPECT_EQ(phase("phase = { type = \"draine\", g = 0.5, alpha = 3 }"),
              made(R"({"type": "DRAINE", "inputs": {"Anisotropy": 0.5, "Alpha": 3.0}})"));
    EXPECT_EQ(phase("phase = { type = \"mie\", diameter = 7 }"),
              made(R"({"type": "MIE", "inputs": {"Diameter": 7.0}})"));
    EXPECT_EQ(phase("phase = { type = \"fournier_forand\", ior = 1.1, backscatter = 0.02 }"),
              made(R"({"type": "FOURNIER_FORAND", "inputs": {"IOR": 1.1, "Backscatter": 0.02}})"));
}

TEST(CyclesScene, RefusesByNameWhatCyclesCannotExpress) {
    const std::string fog = fogScene();
    const auto refused = [&](const std::string& text, const std::vector<std::string>& said) {
        for (const std::string& words : said)
            expectError(ErrorKind::Input, words, [&] { written(text); });
    };
    std::string forward = fog;
    forward.replace(forward.find("g = 0.3"), 7, "g = 0.9999");
    refused(forward, {"test.toml:6:", "Cycles cannot express", "0.9999", "0.999"});
    forward.replace(forward.find("g = 0.9999"), 10,
                    "phase = { type = \"two_lobe\", g = 0.5, g2 = -0.5, mix = 0.5 }");
    refused(forward, {"test.toml:6:", "Cycles cannot express", "type two_lobe"});
    refused(
        fog + "[[light]]\ntype = \"sun\"\nelevation = 40\nangular_diameter = 5\nvisible = true\n",
        {"test.toml:20:", "a sun that the camera sees"});
    refused(fog + "transparent_shadows = true\n", {"test.toml:16:", "transparent shadows"});
    refused(fog + "[[surface]]\nplane = {}\n", {"an infinite plane"});
    refused(fog + "[[surface]]\nsphere = {}\nmatte = true\n", {"matte"});
    refused(fog +
                "[[material]]\nname = \"glass\"\ntype = \"dielectric\"\n[[surface]]\nsphere = "
                "{}\nmaterial = \"glass\"\n",
            {"replaces volume[0]"});
}

/// Its grids hold `value`; those of `wide` have voxels twice as wide.
GridSpec smallGrid(const std::string& name, double value, double background = 0,
                   bool wide = false) {
    GridSpec grid;
    grid.name = name;
    grid.worldFromIndex = Affine3d::scale(Vec3d{1, 1, 1} * (wide ? 1.0 : 0.5));
    grid.box = {{0, 0, 0}, {3, 3, 3}};
    grid.background = {background, 0, 0};
    grid.value = [value](Vec3i) { return value; };
    return grid;
}

TEST(CyclesScene, MotionBecomesThatOfCycles) {
    const TempDir dir;
    GridSpec velocity{.name = "vel", .type = VdbType::Vec3s, .box = {{0, 0, 0}, {3, 3, 3}}};
    velocity.worldFromIndex = smallGrid("", 1).worldFromIndex;
    velocity.colour = [](Vec3i) { return Vec3d{1, -2, 3}; };
    velocity.gridClass = "unknown";
    const auto scene = [&](const std::string& keys, const std::string& shutter) {
        return written("[[volume]]\nfile = \"" + (dir / "a.vdb").string() + "\"\n" + keys +
                       "[[light]]\ntype = \"environment\"\n[camera]\nshutter = " + shutter +
                       "\n[render]\nfps = 12\n");
    };
    writeVdb(dir / "a.vdb", {smallGrid("density", 1), velocity});
    const nlohmann::json moving = scene("velocity_scale = 2\n", "0.5");
    EXPECT_EQ(moving["volumes"][0]["velocity"]["grid"], "vel");
    EXPECT_EQ(moving["volumes"][0]["velocity"]["scale"], 2);
    EXPECT_EQ(moving["camera"]["shutter"], 0.5);
    EXPECT_EQ(moving["camera"]["fps"], 12);
    EXPECT_EQ(scene("velocity_unit = \"frame\"\n", "1")["volumes"][0]["velocity"]["scale"], 12);
    EXPECT_TRUE(scene("", "0")["volumes"][0]["velocity"].is_null());
    EXPECT_EQ(moving["camera"]["shutter_position"], "CENTER");
    EXPECT_EQ(scene("", "[0, 0.5]")["camera"]["shutter_position"], "START");
    EXPECT_EQ(scene("velocity_scale = 0\n", "[-0.5, 0]")["camera"]["shutter_position"], "END");
    expectError(ErrorKind::Input, "velocities while a shutter closes at the frame",
                [&] { scene("", "[-0.5, 0]"); });
    expectError(ErrorKind::Input, "a shutter that is neither open for as long before the frame",
                [&] { scene("", "[-0.1, 0.5]"); });
    velocity.gridClass = "staggered";
    writeVdb(dir / "a.vdb", {smallGrid("density", 1), velocity});
    expectError(ErrorKind::Input, "staggered velocities", [&] { scene("", "0.5"); });
    EXPECT_EQ(
        scene("velocity_sampling = \"collocated\"\n", "0.5")["volumes"][0]["velocity"]["grid"],
        "vel");
}

/// Where things are at the ends of even pieces of the shutter.
TEST(CyclesScene, KeysBecomePlacesWithinTheShutter) {
    const auto with = [](const std::string& more, const std::string& camera) {
        return written(
            "[[volume]]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\nsigma_s = 1\n"
            "transform = { translate = { keys = [[0, [0, 0, 0]], [1, [8, 0, 0]]] } }\n"
            "[[surface]]\nbox = { min = [3, 3, 3], max = [4, 4, 4] }\n" +
            more + "[camera]\nlook_at = [0, 0, 0]\nshutter = [0, 0.5]\n" + camera);
    };
    const nlohmann::json scene = with(
        "[[light]]\ntype = \"sphere\"\nradius = 1\nposition = { keys = [[0, [9, 0, 0]], [1, "
        "[9, 4, 0]]] }\n",
        "fov = { keys = [[0, 30], [1, 50]] }\neye = { keys = [[0, [0, 0, 9]], [1, [0, 0, "
        "7]]] }\n");
    const nlohmann::json& camera = scene["camera"];
    ASSERT_EQ(camera["times"].size(), 17u);
    EXPECT_EQ(camera["times"][0], 0);
    EXPECT_EQ(camera["times"][16], 0.5);
    const auto at = [](const nlohmann::json& places, std::size_t i, std::size_t row) {
        return places.at(i)[row][3].get<double>();
    };
    EXPECT_NEAR(at(scene["volumes"][0]["motion"], 4, 0), 1, 1e-9);  // an eighth of a frame
    EXPECT_NEAR(at(scene["lights"][0]["motion"], 16, 1), 2, 1e-9);
    EXPECT_NEAR(at(camera["motion"], 8, 2), 8.5, 1e-9);
    EXPECT_NEAR(camera["angles"][8].get<double>(), 35 * pi / 180, 1e-9);
    EXPECT_TRUE(scene["surfaces"][0]["motion"][0].is_null());
    const std::string still = "eye = [0, 0, 9]\n";
    EXPECT_TRUE(with("", still)["camera"]["motion"].is_null());
    expectError(ErrorKind::Input, "a light whose size or brightness changes", [&] {
        with(
            "[[light]]\ntype = \"sphere\"\nradius = { keys = [[0, 1], [1, 2]] }\nposition = [9, "
            "0, 0]\n",
            still);
    });
    expectError(ErrorKind::Input, "a point light that moves", [&] {
        with(
            "[[light]]\ntype = \"point\"\nposition = { keys = [[0, [9, 0, 0]], [1, [9, 4, 0]]] "
            "}\n",
            still);
    });
    expectError(ErrorKind::Input, "that 'camera' jumps", [&] {
        with("",
             "eye = { keys = [[0, [0, 0, 9]], [0.2, [0, 1, 9]]], interpolation = "
             "\"constant\" }\n");
    });
}

class CyclesFire : public testing::Test {
protected:
    void SetUp() override {
        writeVdb(dir / "fire.vdb",
                 {smallGrid("density", 1), smallGrid("flame", 2), smallGrid("temperature", 3),
                  smallGrid("heat", 1, 0, true), smallGrid("air", 300, 293)});
    }
    nlohmann::json volumes(const std::string& keys) const {
        return written("[[volume]]\nfile = \"" + (dir / "fire.vdb").string() + "\"\n" + keys +
                       "\n[[light]]\ntype = \"environment\"\n")["volumes"];
    }
    TempDir dir;
};

TEST_F(CyclesFire, GlowsFromTheSameObjectWhereTheVoxelsAreTheSame) {
    const auto smoke = volumes(
        "scale = 2\nemission = { grid = \"flame\", scale = [1, 4, 2] }\n"
        "blackbody = { scale = 1400, intensity = 0.5, colour = [1, 0.5, 0.25] }");
    ASSERT_EQ(smoke.size(), 1u);
    EXPECT_EQ(smoke[0]["grid"], "density");
    EXPECT_EQ(
        smoke[0]["emission"],
        nlohmann::json::parse(R"({"grid": "flame", "strength": 4.0, "colour": [0.25, 1.0, 0.5]})"));
    EXPECT_EQ(smoke[0]["blackbody"],
              nlohmann::json::parse(R"({"grid": "temperature", "temperature": 1400.0,
                                        "intensity": 1.0, "tint": [0.5, 0.25, 0.125]})"));

    const auto apart = volumes("scale = 2\nemission = { grid = \"heat\" }");
    ASSERT_EQ(apart.size(), 2u);
    EXPECT_EQ(apart[0]["emission"], nullptr);
    EXPECT_EQ(apart[1]["grid"], nullptr);
    EXPECT_FALSE(apart[1]["scatters"]);
    EXPECT_EQ(apart[1]["emission"]["grid"], "heat");

    const auto fire = volumes("sigma_a = 0\nblackbody = {}");
    ASSERT_EQ(fire.size(), 1u);
    EXPECT_EQ(fire[0]["grid"], nullptr);
    EXPECT_EQ(volumes("scale = 1\nemission = 3")[0]["emission"]["grid"], "density");
    EXPECT_EQ(volumes("scale = 1\nemission = 0")[0]["emission"], nullptr);
}

TEST_F(CyclesFire, IsEvenInBoxesAndSurfaces) {
    const std::string box = "box = { min = [-1, -1, -1], max = [1, 1, 1] }\n";
    const auto scene = written(
        "[[volume]]\n" + box + "emission = [1, 2, 4]\n[[surface]]\n" + box +
        "transform = { translate = [5, 0, 0] }\nmaterial = \"glass\"\nmedium = { emission = 9 }\n"
        "[[material]]\nname = \"glass\"\ntype = \"dielectric\"\nior = 1.5\n");
    EXPECT_EQ(scene["volumes"][0]["emission"]["strength"], 4);
    EXPECT_EQ(scene["volumes"][0]["emission"]["grid"], "");
    EXPECT_EQ(scene["surfaces"][0]["medium"]["emission"]["strength"], 4);
}

TEST_F(CyclesFire, IsRefusedByNameWhereCyclesDiffers) {
    const auto refused = [&](const std::string& blackbody, const std::string& words) {
        expectError(ErrorKind::Input, words,
                    [&] { volumes("scale = 1\nblackbody = { " + blackbody + " }"); });
    };
    refused("offset = 273", "test.toml:4:24: Cycles cannot express an offset of temperatures, 273");
    refused("scale = -1", "test.toml:4:23: Cycles cannot express a scale of temperatures below 0");
    refused(
        "temperature = \"air\"",
        "test.toml:4:13: Cycles cannot express the background 293 of the temperature grid 'air'");
}

TEST(CyclesScene, ASkyIsAnImageAndASun) {
    const std::string text =
        "[[volume]]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\nsigma_s = 1\n"
        "[[light]]\ntype = \"sky\"\nelevation = 30\nazimuth = 90\nstrength = 0.5\n";
    const auto lights = written(text)["lights"];
    ASSERT_EQ(lights.size(), 2u);
    EXPECT_EQ(lights[0]["type"], "environment");
    EXPECT_EQ(lights[0]["image"], "sky0.exr");
    EXPECT_EQ(lights[0]["radiance"], (std::vector<float>{0.5, 0.5, 0.5}));
    EXPECT_EQ(lights[1]["type"], "sun");
    EXPECT_NEAR(lights[1]["direction"][0].get<double>(), -std::sqrt(0.75), 1e-12);
    EXPECT_NEAR(lights[1]["direction"][1].get<double>(), -0.5, 1e-12);
    EXPECT_NEAR(lights[1]["angle"].get<double>(), 0.53 * pi / 180, 1e-12);
    EXPECT_EQ(written(text + "sun = false\n")["lights"].size(), 1u);

    const TempDir dir;
    tool::writeCyclesSkies(dir.path(), parseSceneText(text, "test.toml", ""));
    const image::Image sky = image::readImage(dir / "sky0.exr");
    ASSERT_EQ(sky.width, 2 * sky.height);
    const Rgb ground = sky.at(0, sky.height - 1);
    EXPECT_EQ(sky.at(sky.width / 2, sky.height - 5), ground);
    EXPECT_GT(sky.at(sky.width / 2, sky.height / 3).minimum(),
              2 * sky.at(0, sky.height / 3).maximum());
}

TEST(CyclesScene, LampsHaveBlendersUnits) {
    const auto lamp = [](const std::string& lines) {
        return written(
            "[[volume]]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\nsigma_s = 1\n"
            "[[light]]\n" +
            lines)["lights"][0];
    };
    const auto spot = lamp(
        "type = \"spot\"\nposition = [1, 2, 3]\ndirection = [0, 0, -2]\npower = [8, 4, 2]\n"
        "cone = 90\nblend = 0.3\n");
    EXPECT_NEAR(spot["power"].get<double>(), 8, 1e-5);
    EXPECT_NEAR(spot["colour"][1].get<double>(), 0.5, 1e-6);
    EXPECT_NEAR(spot["cone"].get<double>(), pi / 2, 1e-12);
    EXPECT_EQ(spot["blend"], 0.3);
    EXPECT_EQ(spot["direction"], (std::vector<double>{0, 0, -1}));

    // Cycles: radiance = power / (pi area). It shines along -z of its matrix, by rows.
    const auto rectangle = lamp(
        "type = \"rectangle\"\nsize = [2, 1]\nradiance = 3\nspread = 60\n"
        "transform = { translate = [1, 2, 3], scale = [2, 1, 1] }\n");
    EXPECT_EQ(rectangle["shape"], "RECTANGLE");
    EXPECT_EQ(rectangle["size"], (std::vector<double>{4, 1}));
    EXPECT_NEAR(rectangle["power"].get<double>(), pi * 4 * 3, 1e-4);
    EXPECT_NEAR(rectangle["spread"].get<double>(), pi / 3, 1e-12);
    EXPECT_EQ(rectangle["matrix"][1][2], -1);
    EXPECT_EQ(rectangle["matrix"][0][0], 1);
    EXPECT_EQ(rectangle["matrix"][2][3], 3);
    const auto disk = lamp("type = \"disk\"\nradius = 2\n");
    EXPECT_EQ(disk["size"], (std::vector<double>{4, 4}));
    EXPECT_NEAR(disk["power"].get<double>(), pi * 4 * pi, 1e-4);

    const auto refused = [&](const std::string& lines, const std::string& words) {
        expectError(ErrorKind::Input, words, [&] { lamp(lines); });
    };
    refused("type = \"disk\"\ntwo_sided = true\n", "both sides");
    refused("type = \"spot\"\nposition = [1, 2, 3]\ndirection = [0, 0, -2]\ncone = 0.5\n",
            "cone of 0.5 degrees");
}

}  // namespace
}  // namespace woodcock::test
