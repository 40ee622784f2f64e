// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/support/environment_variable.h"
#include "tests/support/expect_error.h"
#include "tests/support/paths.h"
#include "tests/support/read_back.h"
#include "tests/support/run_program.h"
#include "tests/support/write_vdb.h"
#include "tools/cycles_scene.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/defaults.h"
#include "woodcock/scene/parse.h"

namespace woodcock::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* fogScene = R"([[volume]]
box = { min = [-1, -1, -1], max = [1, 1, 1] }
scale = 1.5
albedo = 0.8
g = 0.3
[[light]]
type = "environment"
[camera]
eye = [2, 1, 4]
look_at = [0, 0, 0]
fov = 30
[render]
resolution = [24, 24]
spp = 256
)";

class Cycles : public testing::Test {
protected:
    void SetUp() override { writeText(dir / "fog.toml", fogScene); }

    std::string file(const std::string& name) const { return (dir / name).string(); }

    /// A program that stands for Blender: tells a version, and else runs the shell's words.
    std::string fakeBlender(const std::string& words,
                            const std::string& version = "Blender 4.2.0") const {
        writeText(dir / "fake", fmt::format("#!/bin/sh\nif [ \"$1\" = --version ]; then echo "
                                            "'{}'; exit; fi\nfor d in \"$@\"; do :; done\n{}\n",
                                            version, words));
        fs::permissions(dir / "fake", fs::perms::owner_all);
        return file("fake");
    }

    std::vector<std::string> cycles(const std::string& blender,
                                    const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"cycles",        file("fog.toml"), "-o",
                                           file("out.exr"), "--blender",      blender};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }

    void expectFailure(const std::vector<std::string>& arguments, int exitCode,
                       const std::vector<std::string>& said) const {
        const ProgramResult result = runProgram(arguments);
        EXPECT_EQ(result.exitCode, exitCode) << result.err;
        for (const std::string& words : said)
            EXPECT_NE(result.err.find(words), std::string::npos)
                << "says:     " << result.err << "expected: " << words;
        EXPECT_FALSE(fs::exists(file("out.exr")));
    }

    TempDir dir;
};

TEST_F(Cycles, SaysHowToGetABlenderWhereThereIsNone) {
    const EnvironmentVariable path("PATH", dir.path().string());
    const EnvironmentVariable blender("BLENDER", "");
    expectFailure({"cycles", file("fog.toml"), "-o", file("out.exr")}, 2,
                  {"no Blender is found", "apt install blender", "--blender"});
}

TEST_F(Cycles, RefusesProgramsThatAreNoBlender) {
    expectFailure(cycles(file("nothing")), 2, {"cannot start", "nothing", "No such file"});
    expectFailure(cycles(fakeBlender("", "GIMP 2.10")), 2,
                  {"--blender", "neither Blender nor a Python", "GIMP 2.10"});
    const EnvironmentVariable blender("BLENDER", fakeBlender("", "GIMP 2.10"));
    expectFailure({"cycles", file("fog.toml"), "-o", file("out.exr")}, 2, {"$BLENDER"});
}

TEST_F(Cycles, ShowsWhatAFailingBlenderSaid) {
    expectFailure(cycles(fakeBlender("echo the kernel is gone >&2; exit 7")), 1,
                  {"Blender 4.2.0", "exit code 7", "the kernel is gone"});
    expectFailure(cycles(fakeBlender("kill -SEGV $$")), 1, {"exit code 139"});
    expectFailure(cycles(fakeBlender("exit 0")), 1, {"exit code 0"});
    expectFailure(cycles(fakeBlender("echo '{' > $d/result.json")), 1, {"exit code 0"});
    expectFailure(cycles(fakeBlender("echo '{\"version\": \"4.2.0\"}' > $d/result.json")), 1,
                  {"exit code 0"});
    expectFailure(cycles(fakeBlender("echo '{\"version\": \"4.2.0\"}' > $d/result.json; echo no > "
                                     "$d/image.exr")),
                  3, {"image.exr"});
    expectFailure(cycles(fakeBlender("echo \"ModuleNotFoundError: No module named 'bpy'\"; exit 1",
                                     "Python 3.11.2")),
                  2, {"has no module bpy", "pip install bpy"});
}

TEST_F(Cycles, PassesOnWhatABlenderRefuses) {
    expectFailure(
        cycles(fakeBlender("echo '{\"refused\": \"Blender 2.8 is too old\"}' > $d/result.json")), 3,
        {"Blender 2.8 is too old"});
}

TEST_F(Cycles, RefusesWrongUsage) {
    const std::string blender = fakeBlender("exit 0");
    expectFailure({"cycles", file("fog.toml")}, 2, {"there is no output"});
    expectFailure({"cycles", file("fog.toml"), "-o", file("out.png")}, 2, {"is no .exr file"});
    expectFailure(cycles(blender, {"--save", file("out.exr")}), 2, {"is no .blend file"});
    expectFailure(cycles(blender, {"--mode", "nul"}), 2, {"unknown word 'nul'", "null"});
    expectFailure(cycles(blender, {"--mode", "null", "--step-rate", "1"}), 2, {"--step-rate"});
    expectFailure({"cycles", file("none.toml"), "-o", file("out.exr")}, 3, {"none.toml"});
}

TEST_F(Cycles, CompareRefusesWrongUsage) {
    const auto expectRefused = [](const std::vector<std::string>& arguments, const char* part) {
        const ProgramResult run = runProgram(arguments);
        EXPECT_EQ(run.exitCode, 2) << run.err;
        EXPECT_NE(run.err.find(part), std::string::npos) << run.err;
    };
    expectRefused({"compare"}, "nothing to compare");
    expectRefused({"compare", "a.exr", "--cycles", file("fog.toml")}, "not both");
    expectRefused({"compare", "a.exr", "b.exr", "--spp", "4"}, "belong to --cycles");
    expectRefused({"compare", "--cycles", file("fog.toml"), "--blender", file("none"), "--report",
                   file("report")},
                  "none");
    EXPECT_FALSE(fs::exists(dir / "report/compare.html"));
}

TEST_F(Cycles, EndsWhatItStartedWhenInterrupted) {
    writeText(dir / "pid", "");
    RunningProgram program(
        cycles(fakeBlender(fmt::format("echo $$ > {}; echo 'Sample 1/9'; sleep 60", file("pid"))),
               {"--log-level", "debug"}));
    ASSERT_NE(program.awaitLine("Sample 1/9"), "");
    program.signal(SIGINT);
    const ProgramResult result = program.wait();
    EXPECT_EQ(result.exitCode, 130);
    EXPECT_NE(result.err.find("nothing is written"), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(file("out.exr")));
    EXPECT_NE(kill(std::atoi(readText(dir / "pid").c_str()), 0), 0);
}

/// What the scene for Cycles is made of.
nlohmann::json written(const std::string& text) {
    SceneDescription scene = parseSceneText(text, "test.toml", "");
    const LoadedScene loaded = loadScene(scene);
    completeScene(scene, loaded);
    return nlohmann::json::parse(tool::cyclesScene(scene, loaded, {}));
}

TEST(CyclesScene, ScatteringsBecomeBounces) {
    const std::string fog = fogScene;
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
    EXPECT_EQ(none["absorb_colour"], (std::vector<float>{0, 0, 0}));
}

TEST(CyclesScene, RefusesByNameWhatCyclesCannotExpress) {
    const std::string fog = fogScene;
    const auto refused = [&](const std::string& text, const std::vector<std::string>& said) {
        for (const std::string& words : said)
            expectError(ErrorKind::Input, words, [&] { written(text); });
    };
    std::string forward = fog;
    forward.replace(forward.find("g = 0.3"), 7, "g = 0.9999");
    refused(forward, {"test.toml:5:", "Cycles cannot express", "0.9999", "0.999"});
    refused(
        fog + "[[light]]\ntype = \"sun\"\nelevation = 40\nangular_diameter = 5\nvisible = true\n",
        {"test.toml:19:", "a sun that the camera sees"});
    refused(fog + "transparent_shadows = true\n", {"test.toml:15:", "transparent shadows"});
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

TEST(BlenderAddOn, MapsCyclesParameters) {
    if (!fs::exists("/usr/bin/python3")) GTEST_SKIP() << "no python3";
    const ProgramResult result =
        runProgram({(sourceDir() / "tests/programs/blender_mapping.py").string(),
                    (sourceDir() / "tools/blender/woodcock_addon").string()},
                   {}, "/usr/bin/python3");
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_NE(result.err.find("Ran 10 tests"), std::string::npos) << result.err;
}

TEST(Ladder, ScenesParse) {
    int count = 0;
    for (const auto& entry : fs::directory_iterator(sourceDir() / "data/scenes/ladder")) {
        if (entry.path().extension() != ".toml") continue;
        EXPECT_NO_THROW(parseScene(entry.path())) << entry.path();
        ++count;
    }
    EXPECT_GE(count, 8);
}

// ---- with the Blender of this machine

class WithBlender : public Cycles {
protected:
    void SetUp() override {
        Cycles::SetUp();
        const char* wanted = std::getenv("BLENDER");
        blender_ = wanted && *wanted ? wanted : "/usr/bin/blender";
        if (!fs::exists(blender_)) GTEST_SKIP() << "no Blender; name one in $BLENDER";
    }

    ReadBack draw(const std::string& scene, const std::vector<std::string>& more = {}) const {
        writeText(dir / "scene.toml", scene);
        std::vector<std::string> arguments{"cycles",    file("scene.toml"), "-o", file("out.exr"),
                                           "--blender", blender_,           "-q", "--threads",
                                           "2"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = runProgram(arguments);
        EXPECT_EQ(result.exitCode, 0) << result.err;
        return readBack(dir / "out.exr");
    }

    std::string blender_;
};

/// The optical depth along a ray of a tent of this height and half width around a point.
double depthOfTent(const CameraRay& ray, Vec3d centre, double half, double height) {
    const double middle = dot(centre - ray.origin, ray.direction), reach = 2 * half;
    constexpr int steps = 400;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const Vec3d p = ray.origin + ray.direction * (middle + reach * (2 * (i + 0.5) / steps - 1));
        double value = height;
        for (int axis = 0; axis < 3; ++axis)
            value *= std::max(0.0, 1 - std::abs(p[axis] - centre[axis]) / half);
        sum += value;
    }
    return sum * 2 * reach / steps;
}

/// How much is missing from a white picture, and the middle of it in pixels.
struct Shadow {
    double sum = 0, x = 0, y = 0;
    void add(int column, int row, double missing) {
        sum += missing, x += missing * column, y += missing * row;
    }
};

TEST_F(WithBlender, AVoxelLiesWhereOpenVdbHasIt) {
    GridSpec grid;
    grid.name = "density";
    grid.worldFromIndex = Affine3d::scale({0.5, 0.5, 0.5});
    grid.box = {{3, -2, 1}, {3, -2, 1}};
    grid.value = [](Vec3i) { return 1.0; };
    writeVdb(dir / "voxel.vdb", {grid});
    const std::string scene = R"([[volume]]
file = "voxel.vdb"
density = "density"
scale = 2
albedo = 0
[[light]]
type = "environment"
[camera]
type = "orthographic"
eye = [2.5, 0.5, 3.5]
look_at = [1.5, -1, 0.5]
height = 2
[render]
resolution = [32, 32]
spp = 256
)";
    const ReadBack image = draw(scene);
    const Camera camera = Camera::orthographic({2.5, 0.5, 3.5}, {1.5, -1, 0.5}, {0, 1, 0}, 2);
    Shadow expected, found;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) {
            const CameraRay ray = camera.ray(x + 0.5, y + 0.5, 32, 32);
            expected.add(x, y, -std::expm1(-depthOfTent(ray, {1.5, -1, 0.5}, 0.5, 2)));
            found.add(x, y, 1 - double{image.at(x, y, "R")});
        }
    // A pixel's noise is below 0.03 of a sample of one; half a voxel would be 4 pixels.
    EXPECT_NEAR(found.sum / expected.sum, 1, 0.01);
    EXPECT_NEAR(found.x / found.sum, expected.x / expected.sum, 0.05);
    EXPECT_NEAR(found.y / found.sum, expected.y / expected.sum, 0.05);
}

/// Their means over all pixels agree within their noise, which the pixels' differences show.
void expectSameMeans(const ReadBack& theirs, const ReadBack& ours, double largestError) {
    for (const char* channel : {"R", "G", "B"}) {
        double a = 0, b = 0, squares = 0;
        for (int y = 0; y < ours.height; ++y)
            for (int x = 0; x < ours.width; ++x) {
                const double p = theirs.at(x, y, channel), q = ours.at(x, y, channel);
                a += p, b += q, squares += (p - q) * (p - q);
            }
        const double error = std::sqrt(squares) / b;
        EXPECT_LT(error, largestError) << channel;
        EXPECT_NEAR(a / b, 1, 4 * error) << channel;
    }
}

TEST_F(WithBlender, FogIsAsBright) {
    const ReadBack theirs = draw(fogScene, {"--seed", "5"});
    const ProgramResult result =
        runProgram({"render", file("fog.toml"), "-o", file("ours.exr"), "-q", "--spp", "1024"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    expectSameMeans(theirs, readBack(dir / "ours.exr"), 0.002);
    EXPECT_TRUE(theirs.attributes.contains("woodcock/blender"));
    EXPECT_TRUE(theirs.attributes.contains("woodcock/cyclesMode"));
}

TEST_F(WithBlender, CompareRendersBoth) {
    const ProgramResult run =
        runProgram({"compare", "--cycles", file("fog.toml"), "--blender", blender_, "--spp", "16",
                    "--report", file("report"), "--json"});
    EXPECT_EQ(run.exitCode, 0) << run.err;
    EXPECT_NE(run.err.find("B: Cycles of Blender"), std::string::npos) << run.err;
    for (const char* name : {"woodcock.exr", "woodcock_2.exr", "cycles.exr", "cycles_2.exr",
                             "compare.html", "compare.json"})
        EXPECT_TRUE(fs::exists(dir / "report" / name)) << name;
    const auto json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json.at("images").size(), 2u) << run.out;
}

TEST_F(WithBlender, ExportsWhatCyclesDraws) {
    // Fine voxels: before 5.0, Cycles makes light of interpolated temperatures.
    const auto ball = [](const std::string& name, Vec3d centre) {
        GridSpec grid;
        grid.name = name;
        grid.worldFromIndex = Affine3d::scale(Vec3d{1, 1, 1} / 30.0);
        grid.box = {{-30, -30, -30}, {30, 30, 30}};
        grid.value = [centre](Vec3i p) {
            const Vec3d d = Vec3d{p.x / 30.0, p.y / 30.0, p.z / 30.0} - centre;
            return std::max(0.0, 1 - dot(d, d));
        };
        return grid;
    };
    writeVdb(dir / "ball.vdb", {ball("density", {}), ball("temperature", {-0.2, 0, 0}),
                                ball("flame", {0.3, 0.2, 0.3})});
    const EnvironmentVariable woodcock("WOODCOCK", program().string());
    const ProgramResult made =
        runProgram({"-b", "--factory-startup", "--python-exit-code", "1", "-P",
                    (sourceDir() / "tests/programs/blender_export.py").string(), "--",
                    (sourceDir() / "tools/blender").string(), dir.path().string()},
                   {}, blender_);
    ASSERT_EQ(made.exitCode, 0) << made.out << made.err;
    EXPECT_NE(made.out.find("CANCELLED 130 True True"), std::string::npos) << made.out;
    const std::string scene = readText(dir / "scene.toml");
    for (const char* words :
         {"odd: left out: the surface shader",
          "gas: black-body emission is left out: its temperature is the same everywhere inside",
          "emission = { grid = \"flame\"", "blackbody = { temperature = \"temperature\""})
        EXPECT_NE(scene.find(words), std::string::npos) << scene;
    const ProgramResult drawn =
        runProgram({"render", file("scene.toml"), "-o", file("ours.exr"), "-q", "--spp", "1024"});
    ASSERT_EQ(drawn.exitCode, 0) << drawn.err;
    expectSameMeans(readBack(dir / "cycles.exr"), readBack(dir / "ours.exr"), 0.002);
}

}  // namespace
}  // namespace woodcock::test
