// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "woodcock/proof/support/write_vdb.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace proof;
using namespace scene;

namespace {

namespace fs = std::filesystem;

GridSpec cube(const std::string& name = "density") {
    GridSpec grid;
    grid.name = name;
    grid.box = {{0, 0, 0}, {15, 15, 15}};
    grid.value = [](Vec3i p) { return 0.5 + 0.03 * p.x; };
    return grid;
}

/// Runs in a directory of its own that holds `smoke.vdb`.
class Cli : public testing::Test {
protected:
    void SetUp() override { writeVdb(dir / "smoke.vdb", {cube(), cube("flame")}); }

    std::string file(const std::string& name) const { return (dir / name).string(); }

    /// `render` of an input in the directory to out.exr there, small and quick.
    std::vector<std::string> render(const std::string& input,
                                    std::vector<std::string> more = {}) const {
        std::vector<std::string> arguments{"render",        file(input), "-o",
                                           file("out.exr"), "--set",     "render.resolution=[16,8]",
                                           "--threads",     "2"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
    std::vector<std::string> quick(std::vector<std::string> more = {}) const {
        more.insert(more.end(), {"--spp", "2"});
        return render("smoke.vdb", more);
    }

    void expectFailure(const std::vector<std::string>& arguments, int exitCode,
                       const std::vector<std::string>& said) const {
        fs::remove(file("out.exr"));
        const ProgramResult result = runProgram(arguments);
        const std::string line = fmt::format("{}", fmt::join(arguments, " "));
        EXPECT_EQ(result.exitCode, exitCode) << line << "\n" << result.err;
        for (const std::string& words : said)
            EXPECT_NE(result.err.find(words), std::string::npos)
                << line << "\nsays:     " << result.err << "expected: " << words;
        EXPECT_FALSE(fs::exists(file("out.exr"))) << line;
    }

    const TempDir dir;
};

TEST_F(Cli, RendersAVolumeToSeveralFiles) {
    const ProgramResult result =
        runProgram(quick({"-o", file("out.png"), "--stats", file("stats.json")}));
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(readText(file("out.exr")).substr(0, 4), "\x76\x2f\x31\x01");
    EXPECT_EQ(readText(file("out.png")).substr(1, 3), "PNG");
    const auto stats = nlohmann::json::parse(readText(file("stats.json")));
    EXPECT_EQ(stats.at("width"), 16);
    EXPECT_EQ(stats.at("end_sample"), 2);
    EXPECT_EQ(stats.at("non_finite"), 0);
    EXPECT_GE(stats.at("counters").at("paths"), 16 * 8 * 2);
}

TEST_F(Cli, AdaptiveSamplesAreAskedFor) {
    const auto isAdaptive = [&](std::vector<std::string> options) {
        options.insert(options.end(), {"--quiet", "--stats", file("stats.json")});
        const ProgramResult result = runProgram(render("smoke.vdb", options));
        EXPECT_EQ(result.exitCode, 0) << result.err;
        return nlohmann::json::parse(readText(file("stats.json"))).at("adaptive").get<bool>();
    };
    EXPECT_FALSE(isAdaptive({"--spp", "16"}));
    EXPECT_TRUE(isAdaptive({"--spp", "16", "--adaptive"}));
    EXPECT_TRUE(isAdaptive({"--spp", "16", "--quality", "final"}));
    EXPECT_FALSE(isAdaptive({"--spp", "16", "--quality", "final", "--no-adaptive"}));
    EXPECT_FALSE(isAdaptive({"--spp", "16", "--quality", "reference"}));
    EXPECT_FALSE(
        isAdaptive({"--samples", "4:8", "--set", "render.adaptive=true", "--no-adaptive"}));
}

TEST_F(Cli, SaysWhatItChoseAsTheSceneThatWouldFixIt) {
    const ProgramResult result = runProgram(quick({"--write-scene", file("scene.toml")}));
    EXPECT_EQ(result.exitCode, 0) << result.err;
    for (const char* said : {"scale = ", "[camera]", "[[light]]", "uses scattering"})
        EXPECT_NE(result.err.find(said), std::string::npos) << said << "\n" << result.err;

    // Two ways to the same picture, but for the command and the time in its header.
    const ProgramResult again =
        runProgram({"render", file("scene.toml"), "-o", file("again.exr"), "--threads", "1",
                    "--stats", file("again.json"), "--quiet"});
    EXPECT_EQ(again.exitCode, 0) << again.err;
    EXPECT_EQ(again.err, "");
    EXPECT_EQ(runProgram(quick({"--stats", file("stats.json")})).exitCode, 0);
    const auto digest = [&](const char* name) {
        return nlohmann::json::parse(readText(file(name))).at("scene_digest");
    };
    EXPECT_EQ(digest("again.json"), digest("stats.json"));
}

TEST_F(Cli, PrintsTheSceneThatItWouldWrite) {
    const ProgramResult result =
        runProgram({"render", file("smoke.vdb"), "--write-scene", file("written.toml")});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    // Without the lines that introduce each choice.
    std::istringstream lines(result.err);
    std::string toml;
    for (std::string line; std::getline(lines, line);)
        if (!line.starts_with("info: ")) toml += line + "\n";
    SceneDescription printed = parseSceneText(toml, "printed", "");
    SceneDescription written = parseScene(file("written.toml"));
    printed.places.clear(), written.places.clear();
    EXPECT_EQ(printed, written) << result.err;
    EXPECT_EQ(printed.volumes.at(0).blackbody.has_value(), true);
    EXPECT_EQ(std::get<DensityCoefficients>(printed.volumes.at(0).coefficients).albedo,
              (Vec3d{0.6, 0.6, 0.6}));  // of smoke around fire
    EXPECT_EQ(std::get<DensityCoefficients>(printed.volumes[0].coefficients).density, "density");
}

TEST_F(Cli, WritingASceneRendersOnlyWhatTheCommandLineNames) {
    writeText(file("scene.toml"),
              "[[volume]]\nfile = \"smoke.vdb\"\n[render]\nresolution = [8, 8]\nspp = 1\n"
              "[output]\nfiles = [\"out.exr\"]\n");
    const std::vector<std::string> save{"render", file("scene.toml"), "--write-scene",
                                        file("full.toml"), "--quiet"};
    EXPECT_EQ(runProgram(save).exitCode, 0);
    EXPECT_FALSE(fs::exists(file("out.exr")));
    EXPECT_NE(readText(file("full.toml")).find("out.exr\"]"), std::string::npos);

    std::vector<std::string> both = save;
    both.insert(both.end(), {"-o", file("other.exr")});
    EXPECT_EQ(runProgram(both).exitCode, 0);
    EXPECT_TRUE(fs::exists(file("other.exr")));
    EXPECT_FALSE(fs::exists(file("out.exr")));

    std::vector<std::string> stats = save;
    stats.insert(stats.end(), {"--stats", file("stats.json")});
    expectFailure(stats, 2, {"--stats", "--write-scene", "-o"});
}

TEST_F(Cli, StatsAndScenesGoToStdoutAsAMinus) {
    const ProgramResult stats = runProgram(quick({"--stats", "-"}));
    EXPECT_EQ(stats.exitCode, 0) << stats.err;
    EXPECT_EQ(nlohmann::json::parse(stats.out).at("end_sample"), 2);
    const ProgramResult scene = runProgram({"render", file("smoke.vdb"), "--write-scene", "-"});
    EXPECT_EQ(scene.exitCode, 0) << scene.err;
    EXPECT_EQ(parseSceneText(scene.out, "stdout", "").volumes.at(0).file, file("smoke.vdb"));
    EXPECT_FALSE(fs::exists("-"));
}

TEST_F(Cli, AWidthAloneKeepsTheShape) {
    const ProgramResult result = runProgram(quick({"--res", "32", "--stats", file("stats.json")}));
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(nlohmann::json::parse(readText(file("stats.json"))).at("height"), 16);
}

TEST_F(Cli, ProgressForFarmsIsOneJsonObjectOnEachLine) {
    const ProgramResult result = runProgram(quick({"--progress", "json"}));
    EXPECT_EQ(result.exitCode, 0) << result.err;
    std::istringstream lines(result.err);
    std::vector<nlohmann::json> events;
    for (std::string line; std::getline(lines, line);) {
        const auto json = nlohmann::json::parse(line, nullptr, false);
        ASSERT_TRUE(json.is_object()) << line;
        if (json.at("event") != "log") events.push_back(json);
    }
    ASSERT_GE(events.size(), 3u);
    EXPECT_EQ(events.front().at("event"), "start");
    EXPECT_EQ(events.back().at("event"), "done");
    EXPECT_EQ(events.back().at("reason"), "complete");
    const nlohmann::json& last = events[events.size() - 2];
    EXPECT_EQ(last.at("event"), "progress");
    EXPECT_EQ(last.at("fraction"), 1.0);
    EXPECT_EQ(last.at("samples"), 2);
    for (const char* key : {"seconds", "seconds_left", "noise"})
        EXPECT_TRUE(last.at(key).is_number()) << key;
}

TEST_F(Cli, ErrorsAreJsonTooWhereProgressIs) {
    const ProgramResult result =
        runProgram(render("missing.vdb", {"--spp", "1", "--progress", "json"}));
    EXPECT_EQ(result.exitCode, 3);
    const auto line = nlohmann::json::parse(result.err);
    EXPECT_EQ(line.at("level"), "error");
    EXPECT_NE(line.at("message").get<std::string>().find("missing.vdb"), std::string::npos);
}

class CliInterrupt : public Cli, public testing::WithParamInterface<int> {};

TEST_P(CliInterrupt, WritesWhatIsThere) {
    RunningProgram running(render(
        "smoke.vdb", {"--spp", "1000000000", "--progress", "json", "--stats", file("stats.json")}));
    std::string line;
    do line = running.awaitLine("\"event\":\"progress\"");
    while (!line.empty() && nlohmann::json::parse(line).at("samples") == 0);
    ASSERT_FALSE(line.empty());
    running.signal(GetParam());
    const ProgramResult result = running.wait();
    EXPECT_EQ(result.exitCode, 130) << result.err;
    EXPECT_TRUE(fs::exists(file("out.exr")));
    const auto stats = nlohmann::json::parse(readText(file("stats.json")));
    EXPECT_EQ(stats.at("reason"), "interrupted");
    EXPECT_GE(stats.at("end_sample"), nlohmann::json::parse(line).at("samples"));
}

INSTANTIATE_TEST_SUITE_P(Signals, CliInterrupt, testing::Values(SIGINT, SIGTERM));

TEST_F(Cli, TheProgramKnowsItsVersionAndOptions) {
    const std::string about = runProgram({"--version"}).out;
    EXPECT_EQ(about.find("woodcock 0.1.0\n"), 0U) << about;
    const ProgramResult help = runProgram({"render", "--help"});
    EXPECT_EQ(help.exitCode, 0);
    EXPECT_NE(help.out.find("--time-limit"), std::string::npos);
}

TEST_F(Cli, WrongUsage) {
    expectFailure({}, 2, {"no command", "render", "info"});
    expectFailure({"rendr", "a.vdb"}, 2, {"'rendr'", "did you mean 'render'?"});
    expectFailure({"--verison"}, 2, {"unknown option '--verison'; did you mean '--version'?"});
    expectFailure({"render"}, 2, {"woodcock render: no INPUT is given: A scene (.toml)"});
    expectFailure({"info"}, 2,
                  {"woodcock info: no INPUT is given: One or more volumes (.vdb, .nvdb)"});
    expectFailure({"info", file("smoke.vdb"), "--grid"}, 2, {"--grid has no value", "--grid NAME"});
    expectFailure({"render", "", "-o", file("out.exr")}, 2, {"an input is empty"});
    expectFailure({"render", file("smoke.vdb")}, 2, {"no output", "-o"});
    const auto wrong = [&](std::vector<std::string> options, std::vector<std::string> said) {
        expectFailure(render("smoke.vdb", options), 2, said);
    };
    wrong({"--progess", "bar"}, {"--progess", "did you mean '--progress'?"});
    wrong({"--progress", "baz"}, {"'baz'", "auto, bar, json, alfred, openjd, none"});
    wrong({"--spp", "0"}, {"--spp", "'0'", "from 1"});
    wrong({"--spp", "1", "--spp", "2"}, {"--spp is given twice"});
    wrong({"--spp"}, {"--spp has no value", "--spp COUNT"});
    wrong({"--half=3"}, {"--half takes no value"});
    wrong({"--seed", "-1"}, {"--seed", "'-1'"});
    wrong({"--seed", "9223372036854775808"}, {"--seed", "to 9223372036854775807"});
    wrong({"--samples", "0:2147483648"}, {"--samples", "END <= 2147483647"});
    wrong({"--exposure", "1e9"}, {"--exposure: '1e9'", "from -100 to 100"});
    wrong({"--res", "65536x65536"}, {"--res: 65536 x 65536 pixels need 912 GiB", "--crop"});
    wrong({"--res", "0x8"}, {"--res", "'0x8'", "WIDTHxHEIGHT"});
    wrong({"--samples", "4:4"}, {"--samples", "'4:4'", "FIRST:END"});
    wrong({"--crop", "4,4,4,8"}, {"--crop", "'4,4,4,8'", "X0,Y0,X1,Y1"});
    wrong({"--crop", "0,0,17,8"}, {"--crop", "16x8"});
    wrong({"--time-limit", "soon"}, {"--time-limit", "'soon'"});
    wrong({"--noise", "0"}, {"--noise", "'0'"});
    wrong({"--set", "volume"}, {"volume", "KEY=VALUE"});
    wrong({"--noise", "5"}, {"--noise", "'5'", "up to 1 (100%)"});
    wrong({"--layers", "dept"}, {"--layers: ", "'dept'", "did you mean 'depth'?"});
    wrong({"--layers", "depth,depth"}, {"--layers: the layer 'depth' is named twice"});
    wrong({"-o", file("a.png"), "--view", "Filmish"}, {"'Filmish'", "Standard"});
}

TEST_F(Cli, ContradictoryOptions) {
    const auto wrong = [&](std::vector<std::string> options, std::vector<std::string> said) {
        expectFailure(render("smoke.vdb", options), 2, said);
    };
    wrong({"--spp", "4", "--samples", "0:4"}, {"--spp and --samples"});
    wrong({"--adaptive", "--samples", "0:4"}, {"--adaptive and --samples", "--spp"});
    wrong({"--set", "render.adaptive=true", "--samples", "0:4"},
          {"the scene's adaptive sampling and --samples", "--set render.adaptive=false"});
    wrong({"--quiet", "--progress", "json"}, {"--quiet and --progress"});
    wrong({"--quiet", "--log-level", "debug"}, {"--quiet and --log-level"});
    expectFailure({"render", file("smoke.vdb"), "-o", file("out.png"), "--layers", "depth"}, 2,
                  {"--layers", "EXR"});
    expectFailure({"render", file("smoke.vdb"), "-o", file("out.png"), "--half"}, 2,
                  {"--half is for EXR files"});
    for (const char* option : {"--display", "--view", "--look", "--exposure"})
        wrong({option, "1"}, {std::string(option) + " is for PNG, JPEG, TIFF and WebP files"});
    wrong({file("scene.toml")}, {"a scene file is rendered alone"});
    wrong({"--stats", file("out.exr")}, {"out.exr", "named twice"});
    wrong({"-o", file("smoke.vdb")}, {"smoke.vdb", "an input and an output"});
}

TEST_F(Cli, NothingThatIsReadIsWrittenOver) {
    writeText(file("sky.exr"), "a picture of the sky");
    writeText(file("scene.toml"),
              "[[volume]]\nfile = \"smoke.vdb\"\n"
              "[[light]]\ntype = \"environment\"\nimage = \"sky.exr\"\n");
    expectFailure(render("scene.toml", {"-o", file("sky.exr")}), 2,
                  {"sky.exr", "an input and an output"});
    EXPECT_EQ(readText(file("sky.exr")), "a picture of the sky");
}

TEST_F(Cli, ValuesThatOptionsReplaceAreCheckedAllTheSame) {
    for (const char* value : {"render=[]", "render.resolution=\"a\"", "render.spp=0"})
        expectFailure({"render", file("smoke.vdb"), "-o", file("out.exr"), "--res", "16x8", "--spp",
                       "1", "--set", value},
                      3, {std::string("error: --set ") + value + ": render"});
    expectFailure({"render", file("smoke.vdb"), "-o", file("out.exr"), "--res", "60000", "--set",
                   "render.resolution=[100, 700]"},
                  2, {"--res 60000", "420000 pixels high"});
}

TEST_F(Cli, UnwritableOutputsFailBeforeRendering) {
    fs::create_directory(file("folder.exr"));
    // A render this long would time the test out.
    const auto wrong = [&](const std::string& option, const std::string& path,
                           std::vector<std::string> said) {
        said.push_back(path);
        expectFailure(
            {"render", file("smoke.vdb"), "-o", file("a.exr"), "--spp", "1000000000", option, path},
            2, said);
    };
    wrong("-o", file("nowhere/b.exr"), {"no directory"});
    wrong("-o", file("folder.exr"), {"is a directory"});
    wrong("-o", file("b.tga"), {".tga", ".exr, .png"});
    wrong("-o", file("b"), {".exr, .png"});
    wrong("-o", "/proc/b.exr", {"/proc"});
    wrong("--stats", file("nowhere/s.json"), {"no directory"});
    wrong("--write-scene", file("nowhere/s.toml"), {"no directory"});
    EXPECT_EQ(std::distance(fs::directory_iterator(dir.path()), fs::directory_iterator()), 2);
}

TEST_F(Cli, BadVolumes) {
    const auto bad = [&](const std::string& name, std::vector<std::string> said,
                         std::vector<std::string> options = {}) {
        said.push_back(name);
        expectFailure(render(name, options), 3, said);
    };
    const auto withVoxel = [&](const std::string& name, double value, const std::string& faults) {
        GridSpec grid = cube();
        grid.voxels = {{{1, 2, 3}, {value}}};
        writeVdb(file(name), {grid});
        bad(name, {"density", faults, "1, 2, 3", "--repair"});
    };
    bad("missing.vdb", {"does not exist"});
    writeText(file("text.vdb"), "not a volume at all");
    bad("text.vdb", {"is not a VDB file"});
    writeText(file("nothing.vdb"), "");
    bad("nothing.vdb", {"is not a VDB file"});
    fs::copy_file(file("smoke.vdb"), file("short.vdb"));
    truncateFile(file("short.vdb"), fs::file_size(file("short.vdb")) - 100);
    bad("short.vdb", {"cut short"});
    bad("smoke.vdb", {"'densty'", "did you mean 'density'?", "density (float), flame (float)"},
        {"--set", "volume[0].density=densty"});

    GridSpec velocity = cube("velocity");
    velocity.type = VdbType::Vec3s;
    velocity.value = {};
    velocity.colour = [](Vec3i) { return Vec3d{1, 2, 3}; };
    writeVdb(file("vector.vdb"), {velocity, cube("smoke")});
    bad("vector.vdb", {"velocity", "vec3s", "scalar", "smoke"},
        {"--set", "volume[0].density=velocity"});

    withVoxel("nan.vdb", std::numeric_limits<double>::quiet_NaN(), "NaN");
    withVoxel("infinite.vdb", std::numeric_limits<double>::infinity(), "infinite");
    withVoxel("negative.vdb", -0.25, "negative");
    EXPECT_EQ(runProgram(render("nan.vdb", {"--repair", "--spp", "1"})).exitCode, 0);
}

TEST_F(Cli, EmptyFramesShowWhatIsBehind) {
    GridSpec inactive;
    inactive.voxels = {{{0, 0, 0}, {1}, false}, {{1, 0, 0}, {2}, false}};
    writeVdb(file("inactive.vdb"), {inactive});
    writeVdb(file("empty.vdb"), {GridSpec{}});
    writeVdb(file("none.vdb"), {});
    for (const auto& [name, said] : std::vector<std::pair<std::string, std::string>>{
             {"empty.vdb", "is empty: it has no active voxels"},
             {"inactive.vdb", "has no active voxels, but 2 inactive ones"},
             {"none.vdb", "holds no grids"}}) {
        const ProgramResult run = runProgram(render(name, {"--spp", "1"}));
        EXPECT_EQ(run.exitCode, 0) << run.err;
        EXPECT_NE(run.err.find(file(name)), std::string::npos) << run.err;
        EXPECT_NE(run.err.find(said), std::string::npos) << run.err;
        const ProgramResult info = runProgram({"info", file(name)});
        EXPECT_EQ(info.exitCode, 0) << info.err;
        EXPECT_NE(info.out.find(name == "none.vdb" ? "nothing to be drawn" : "no active voxels"),
                  std::string::npos)
            << info.out;
    }
    // A name that is not there is no empty frame.
    expectFailure(render("empty.vdb", {"--set", "volume[0].density=smoke"}), 3, {"'smoke'"});
}

TEST_F(Cli, BadScenes) {
    const auto bad = [&](const std::string& line, std::vector<std::string> said) {
        writeText(file("scene.toml"), "[[volume]]\nfile = \"smoke.vdb\"\n" + line + "\n");
        said.push_back(file("scene.toml"));
        expectFailure(render("scene.toml"), 3, said);
    };
    bad("g = 1.5", {":3:", "1.5", "between -1 and 1"});
    bad("scal = 2", {":3:", "'scal'", "did you mean 'scale'?"});
    bad("scale = \"two\"", {":3:", "scale", "number"});
    bad("albedo = [1, 2, 3]", {":3:", "albedo", "between 0 and 1"});
    bad("albedo = ", {":3:"});
    bad("[render]\nspp = 0", {":4:", "spp"});
    bad("density = \"dens\"", {":3:11: ", "'dens'", "smoke.vdb", "density (float), flame (float)"});
    writeText(file("scene.toml"), "ocio = \"no.ocio\"\n[[volume]]\nfile = \"smoke.vdb\"\n");
    expectFailure(render("scene.toml"), 3, {file("scene.toml:1:8: cannot read the OpenColorIO")});
    expectFailure(render("scene.toml", {"--ocio", "no.ocio"}), 3, {"error: --ocio: cannot read"});
    expectFailure(render("smoke.vdb", {"--set", "render.resolution=[0,8]"}), 3,
                  {"--set", "resolution[0] is 0"});
    expectFailure(render("missing.toml"), 3, {"missing.toml", "does not exist"});
}

TEST_F(Cli, WrongNamesForDisplayTellWhereTheyWereGiven) {
    const auto expectPlace = [&](const std::string& output, const std::vector<std::string>& more,
                                 const std::string& place) {
        writeText(dir / "view.toml", "[[volume]]\nfile = \"smoke.vdb\"\n[output]\n" + output);
        std::vector<std::string> arguments{
            "render", file("view.toml"), "-o", file("out.png"), "--spp", "1", "--res", "8x8"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        expectFailure(arguments, 2, {place});
    };
    expectPlace("view = \"nosuch\"\n", {}, "view.toml:4:8: view 'nosuch' not found");
    expectPlace("display = \"nosuch\"\n", {}, "view.toml:4:11: display 'nosuch' not found");
    expectPlace("view = \"nosuch\"\n", {"--view", "other"}, "--view: view 'other' not found");
    expectPlace("", {"--set", "output.look=\"none such\""}, "look 'none such' not found");
}

TEST_F(Cli, AFullDiskLeavesNoPartOfAnImage) {
    writeText(file("out.png"), "yesterday's");
    const ProgramResult result =
        runProgram({"render", file("smoke.vdb"), "-o", file("out.exr"), "-o", file("out.png"),
                    "--res", "64x64", "--spp", "1", "--threads", "2", "--quiet"},
                   {.fileSize = 1000});  // of what it says, too
    EXPECT_EQ(result.exitCode, 1) << result.err;
    for (const char* said : {"out.exr", "out.png", "File too large"})
        EXPECT_NE(result.err.find(said), std::string::npos) << said << "\n" << result.err;
    EXPECT_EQ(readText(file("out.png")), "yesterday's");
    EXPECT_EQ(std::distance(fs::directory_iterator(dir.path()), fs::directory_iterator()), 2);
}

TEST_F(Cli, AFullFileSystemLeavesNoPartOfAnImage) {
    const fs::path small = dir / "small";
    fs::create_directory(small);
    if (mount("tmpfs", small.c_str(), "tmpfs", 0, "size=8k") != 0)
        GTEST_SKIP() << "mounting a small file system needs more rights";
    const ProgramResult result =
        runProgram({"render", file("smoke.vdb"), "-o", (small / "out.exr").string(), "--res",
                    "64x64", "--spp", "1", "--threads", "2"});
    const auto left = std::distance(fs::directory_iterator(small), fs::directory_iterator());
    umount(small.c_str());
    EXPECT_EQ(result.exitCode, 1) << result.err;
    EXPECT_NE(result.err.find("No space left"), std::string::npos) << result.err;
    EXPECT_EQ(left, 0);
}

}  // namespace
}  // namespace woodcock::test
