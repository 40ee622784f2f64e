// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/support/environment_variable.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tests/tools/fog_scene.h"
#include "woodcock/camera/camera.h"
#include "woodcock/proof/support/read_back.h"
#include "woodcock/proof/support/write_vdb.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace camera;
using namespace proof;
using namespace scene;

namespace {

namespace fs = std::filesystem;

class Cycles : public testing::Test {
protected:
    void SetUp() override { writeText(dir / "fog.toml", fogScene()); }

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
    expectFailure(cycles(blender, {"--interpolation", "cubic"}), 2, {"'cubic'", "trilinear"});
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

void expectPythonTests(int count, const std::string& program,
                       const std::vector<std::string>& directories) {
    if (!fs::exists("/usr/bin/python3")) GTEST_SKIP() << "no python3";
    std::vector<std::string> arguments{(sourceDir() / "tests/programs" / program).string()};
    for (const std::string& directory : directories)
        arguments.push_back((sourceDir() / directory).string());
    const ProgramResult result = runProgram(arguments, {}, "/usr/bin/python3");
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_NE(result.err.find(fmt::format("Ran {} tests", count)), std::string::npos) << result.err;
}

TEST(BlenderAddOn, MapsCyclesParameters) {
    expectPythonTests(12, "blender_mapping.py", {"tools/blender/woodcock_addon"});
}

TEST(BlenderBridge, MakesMediaOfTheNodesThatThereAre) {
    expectPythonTests(5, "blender_volumes.py", {"tools/blender", "tools/blender/woodcock_addon"});
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
    const ReadBack theirs = draw(fogScene(), {"--seed", "5"});
    const ProgramResult result =
        runProgram({"render", file("fog.toml"), "-o", file("ours.exr"), "-q", "--spp", "1024"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    expectSameMeans(theirs, readBack(dir / "ours.exr"), 0.002);
    EXPECT_TRUE(theirs.attributes.contains("woodcock/blender"));
    EXPECT_TRUE(theirs.attributes.contains("woodcock/cyclesMode"));
    EXPECT_TRUE(theirs.attributes.contains("woodcock/cyclesInterpolation"));
}

TEST_F(WithBlender, LampsLightAFloorAsTheyShould) {
    // A small patch of a white floor, 2 below a lamp that faces it.
    const auto radianceUnder = [&](const std::string& lamp) {
        const ReadBack image = draw(R"([[material]]
name = "white"
type = "diffuse"
colour = 1
[[surface]]
plane = { size = [1, 1] }
material = "white"
[camera]
type = "orthographic"
eye = [0, 1, 0]
look_at = [0, 0, 0]
up = [0, 0, 1]
height = 0.001
[render]
resolution = [8, 8]
spp = 512
[[light]]
position = [0, 2, 0]
direction = [0, -1, 0]
visible = false
)" + lamp);
        double sum = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) sum += image.at(x, y, "R");
        return sum / image.width / image.height;
    };
    // A disk's irradiance under its middle is pi L sin^2 of the angle of its rim. A rectangle as
    // small as a point: L area / h^2; by a spread of 2 a, tan a / (tan a - a) times that.
    EXPECT_NEAR(radianceUnder("type = \"disk\"\nradius = 1\nradiance = 3\n") / (3.0 / 5), 1, 0.005);
    const std::string small = "type = \"rectangle\"\nsize = [0.004, 0.002]\nradiance = 3e5\n";
    const double even = 3e5 * 0.004 * 0.002 / 4 / pi;
    EXPECT_NEAR(radianceUnder(small) / even, 1, 0.005);
    const double a = pi / 6;
    EXPECT_NEAR(radianceUnder(small + "spread = 60\n") / even * (1 - a / std::tan(a)), 1, 0.005);
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
    std::vector<std::string> arguments{(sourceDir() / "tests/programs/blender_export.py").string(),
                                       "--", (sourceDir() / "tools/blender").string(),
                                       dir.path().string()};
    if (fs::path(blender_).filename().string().starts_with("blender")) {
        const auto options = {"-b", "--factory-startup", "--python-exit-code", "1", "-P"};
        arguments.insert(arguments.begin(), options.begin(), options.end());
    }
    const ProgramResult made = runProgram(arguments, {}, blender_);
    ASSERT_EQ(made.exitCode, 0) << made.out << made.err;
    EXPECT_NE(made.out.find("CANCELLED 130 True True"), std::string::npos) << made.out;
    const std::string scene = readText(dir / "scene.toml");
    for (const char* words :
         {"odd: left out: the surface shader",
          "gas: black-body emission is left out: its temperature is the same everywhere inside",
          "emission = { grid = \"flame\"", "blackbody = { temperature = \"temperature\""})
        EXPECT_NE(scene.find(words), std::string::npos) << scene;
    if (made.out.find("MIST") != std::string::npos) {
        EXPECT_NE(scene.find("phase = { type = \"draine\", g = -0.3"), std::string::npos) << scene;
    }
    const ProgramResult drawn =
        runProgram({"render", file("scene.toml"), "-o", file("ours.exr"), "-q", "--spp", "1024"});
    ASSERT_EQ(drawn.exitCode, 0) << drawn.err;
    expectSameMeans(readBack(dir / "cycles.exr"), readBack(dir / "ours.exr"), 0.002);
}

}  // namespace
}  // namespace woodcock::test
