// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "woodcock/image/layers.h"
#include "woodcock/proof/support/read_back.h"
#include "woodcock/proof/support/write_vdb.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace proof;
using namespace scene;

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

GridSpec cube(const std::string& name = "density") {
    GridSpec grid;
    grid.name = name;
    grid.box = {{0, 0, 0}, {15, 15, 15}};
    grid.value = [](Vec3i p) { return 0.5 + 0.03 * p.x; };
    return grid;
}

/// Runs in a directory of its own that holds smoke.vdb.
class Render : public testing::Test {
protected:
    void SetUp() override { writeVdb(dir / "smoke.vdb", {cube()}); }

    std::string file(const std::string& name) const { return (dir / name).string(); }
    void copyOfSmoke(const std::string& name) const {
        fs::create_directories((dir / name).parent_path());
        fs::copy_file(dir / "smoke.vdb", dir / name);
    }

    /// `render` of inputs in the directory, small and quick.
    ProgramResult render(const Words& inputs, const Words& more) const {
        Words arguments{"render"};
        for (const std::string& input : inputs) arguments.push_back(file(input));
        for (const char* word : {"--res", "16x8", "--spp", "2", "--threads", "2"})
            arguments.emplace_back(word);
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runProgram(arguments);
    }
    ProgramResult renderScene(const std::string& text, const Words& more = {}) const {
        writeText(dir / "scene.toml", text);
        Words all{"-o", file("out.exr")};
        all.insert(all.end(), more.begin(), more.end());
        return render({"scene.toml"}, all);
    }

    static void expectSaid(const ProgramResult& result, int exitCode, const Words& said) {
        EXPECT_EQ(result.exitCode, exitCode) << result.err;
        for (const std::string& words : said)
            EXPECT_NE(result.err.find(words), std::string::npos)
                << "says:     " << result.err << "expected: " << words;
    }
    static void expectNotSaid(const ProgramResult& result, const std::string& words) {
        EXPECT_EQ(result.err.find(words), std::string::npos) << result.err;
    }
    std::size_t files() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(dir.path()), fs::directory_iterator()));
    }

    const TempDir dir;
};

TEST_F(Render, FramesAreNotPiledUp) {
    for (const char* frame : {"f.0009.vdb", "f.0010.vdb", "f.0011.vdb"}) copyOfSmoke(frame);
    const Words frames{"f.0010.vdb", "f.0009.vdb", "f.0011.vdb"};
    expectSaid(render(frames, {"-o", file("x.png")}), 2,
               {"f.0010.vdb', '", "f.0009.vdb' and 1 more differ only in a number", "--overlay",
                "woodcock render '" + file("f.####.vdb") + "' --frames 9-11 -o 'f.####.png'"});
    EXPECT_FALSE(fs::exists(dir / "x.png"));
    EXPECT_EQ(render(frames, {"-o", file("x.png"), "--overlay"}).exitCode, 0);
    for (const char* command : {"trade", "cycles"})
        expectSaid(runProgram({command, file("f.0009.vdb"), file("f.0010.vdb")}), 2,
                   {"differ only in a number"});
}

/// As a shell runs what stands between two words of a message, small.
void expectRuns(const fs::path& dir, const std::string& said, const std::string& from,
                const std::string& to) {
    const std::size_t begin = said.find(from), end = said.find(to);
    ASSERT_TRUE(begin != std::string::npos && end != std::string::npos) << said;
    writeText(dir / "said.sh", "set -e\ncd \"" + dir.string() + "\"\nwoodcock() { \"" +
                                   program().string() +
                                   "\" \"$@\" --res 16x8 --quiet --set render.spp=1; }\n" +
                                   said.substr(begin, end - begin) + "\n");
    const ProgramResult shell = runProgram({(dir / "said.sh").string()}, {}, "/bin/sh");
    EXPECT_EQ(shell.exitCode, 0) << shell.err;
}

TEST_F(Render, TheCommandsThatAreSaidWork) {
    for (const char* frame : {"f 1.vdb", "f 2.vdb"}) copyOfSmoke(frame);
    expectRuns(dir.path(), render({"f 1.vdb", "f 2.vdb"}, {"-o", file("x.png")}).err,
               "  woodcock render", "\nIf they");
    EXPECT_TRUE(fs::exists(dir / "f 1.png") && fs::exists(dir / "f 2.png"));
    // Names of no series are taken one by one.
    for (const char* frame : {"t 1_10.vdb", "t 2_20.vdb"}) copyOfSmoke(frame);
    expectRuns(dir.path(), render({"t 1_10.vdb", "t 2_20.vdb"}, {"-o", file("x.png")}).err,
               "  woodcock render", "\nIf they");
    EXPECT_TRUE(fs::exists(dir / "t 1_10.png") && fs::exists(dir / "t 2_20.png"));
}

TEST_F(Render, SeveralVolumesOfOtherNamesAreOnePicture) {
    copyOfSmoke("fire.0001.vdb");
    copyOfSmoke("density.0001.vdb");
    EXPECT_EQ(
        render({"smoke.vdb", "fire.0001.vdb", "density.0001.vdb"}, {"-o", file("x.exr")}).exitCode,
        0);
}

TEST_F(Render, PatternsForFramesAreRefusedWithTheWayThatWorks) {
    copyOfSmoke("f.0009.vdb");
    copyOfSmoke("f.0010.vdb");
    for (const char* name : {"f.####.vdb", "f.%04d.vdb", "f.$F4.vdb", "f.<frame04>.vdb"})
        expectSaid(render({name}, {"-o", file("x.exr")}), 2,
                   {std::string("there is no file '") + file(name), "stands for a frame's number",
                    file(name), " --frames 9-10 -o "});
    expectSaid(render({"none.####.vdb"}, {"-o", file("x.exr")}), 2,
               {"and no file has a number in its place"});
    expectSaid(render({"f.{frame}.vdb"}, {"-o", file("x.exr")}), 2,
               {"'{frame}' is not filled in", "Put ####"});
    expectSaid(renderScene("[[volume]]\nfile = \"f.####.vdb\"\n"), 3,
               {"scene.toml:2:8: ", "'####' stands for a frame's number", "--frames"});
    expectSaid(runProgram({"info", file("f.%04d.vdb")}), 3, {"'%04d' stands for a frame's number"});
    // One that is called so is drawn.
    copyOfSmoke("a.####.vdb");
    EXPECT_EQ(render({"a.####.vdb"}, {"-o", file("x.exr")}).exitCode, 0);
}

TEST_F(Render, FoldersAreToldOf) {
    fs::create_directory(dir / "empty");
    for (const char* frame : {"seq/f.1.vdb", "seq/f.2.vdb", "mixed/a.vdb", "mixed/b.vdb"})
        copyOfSmoke(frame);
    expectSaid(render({"empty"}, {"-o", file("x.exr")}), 3,
               {"is a directory; name a scene", "it holds no .vdb file"});
    expectSaid(render({"mixed"}, {"-o", file("x.exr")}), 2, {"it holds 2 .vdb files, such as"});
    expectSaid(render({"seq"}, {"-o", file("x.exr")}), 2,
               {"It holds 2 frames", "'" + file("seq/f.#.vdb") + "' --frames 1-2 -o 'f.#.png'"});
}

TEST_F(Render, OutputsAreNotNamedByPatterns) {
    for (const char* name : {"x.####.png", "x.%04d.exr", "x.$F4.png"}) {
        expectSaid(render({"smoke.vdb"}, {"-o", file(name)}), 2,
                   {"stands for a frame's number, and no frames are asked for", "--frames 1-48"});
        expectSaid(renderScene("[[volume]]\nfile = \"smoke.vdb\"\n", {"--stats", file(name)}), 2,
                   {"--stats: '", "is not filled in"});
    }
    expectSaid(renderScene("[[volume]]\nfile = \"smoke.vdb\"\n", {"-o", file("x.####.png")}), 2,
               {"no frames are asked for"});
    writeText(dir / "files.toml",
              "[[volume]]\nfile = \"smoke.vdb\"\n[output]\nfiles = [\"x.####.png\"]\n");
    expectSaid(render({"files.toml"}, {}), 2, {"files.toml:4:10: '", "no frames are asked for"});
    EXPECT_EQ(files(), 3u);
}

TEST_F(Render, VelocitiesThatNothingUsesAreSaid) {
    GridSpec velocity = cube("vel");
    velocity.type = VdbType::Vec3s;
    velocity.value = {};
    velocity.colour = [](Vec3i) { return Vec3d{1, 2, 3}; };
    velocity.gridClass = "staggered";
    writeVdb(dir / "moving.vdb", {cube(), velocity});
    const std::string said =
        "moving.vdb: its velocities ('vel') are not used, as the shutter opens";
    expectSaid(render({"moving.vdb"}, {"-o", file("x.exr")}), 0, {"info: ", said});
    expectNotSaid(render({"moving.vdb"}, {"-o", file("x.exr"), "--shutter", "0.5"}), "not used");
    expectSaid(render({"smoke.vdb"}, {"-o", file("x.exr"), "--shutter", "0.5"}), 0,
               {"smoke.vdb: it has no velocities: it stands still while the shutter is open"});
    expectNotSaid(render({"smoke.vdb"}, {"-o", file("x.exr")}), "velocities");
    // As a colour they are used.
    expectNotSaid(renderScene("[[volume]]\nfile = \"moving.vdb\"\nscale = 1\nrepair = true\n"
                              "albedo_grid = \"vel\"\n"),
                  "velocities");
}

TEST_F(Render, ACameraInsideOfDenseSmokeIsSaid) {
    const std::string scene =
        "[[volume]]\nfile = \"smoke.vdb\"\nscale = 100\nalbedo = 0.5\n"
        "[camera]\neye = [7, 7, 7]\nlook_at = [7, 7, 0]\n";
    const ProgramResult inside = renderScene(scene);
    expectSaid(inside, 0,
               {"warning: the camera stands inside volume[0] (smoke.vdb)",
                "units between two collisions", "camera.eye", "lower the volume's scale"});
    expectSaid(inside, 0,
               {"warning: the picture is black: the camera stands inside volume[0] "
                "(smoke.vdb), and no light comes through",
                "noise unknown (no pixel has any light)"});
    expectNotSaid(renderScene(scene, {"--set", "camera.eye=[7,7,60]"}), "stands inside");
}

TEST_F(Render, BlackPicturesAreExplained) {
    const std::string box =
        "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nscale = 1\n";
    const std::string camera = "[camera]\neye = [0, 0, 9]\nlook_at = [0, 0, 0]\n";
    const std::string sun = "[[light]]\ntype = \"sun\"\nelevation = 30\n";
    expectSaid(
        renderScene(box + camera, {"--set", "light[0].irradiance=0", "--set", "light[1].radiance=0",
                                   "--set", "light[1].above=0", "--set", "light[1].below=0",
                                   "--set", "light[2].radiance=0"}),
        0, {"warning: the picture is black: the scene has no light"});
    expectSaid(renderScene(box + sun + camera, {"--set", "camera.look_at=[0,0,99]"}), 0,
               {"the picture is black: nothing of the scene is in the picture", "camera.look_at"});
    expectSaid(renderScene(box + "albedo = 0\n" + sun + camera), 0,
               {"the picture is black: the volumes only absorb"});
    expectSaid(renderScene(box + sun + camera, {"--set", "render.max_scatterings=0"}), 0,
               {"the picture is black: render.max_scatterings is 0"});
    expectSaid(
        renderScene(box + sun + camera, {"-o", file("x.png"), "--exposure", "-30"}), 0,
        {"the picture is black, as its brightest pixel is", "the exposure -30", "--exposure +"});
    expectNotSaid(renderScene(box + sun + camera, {"-o", file("x.png")}), "black");
    expectSaid(runProgram({"render", file("scene.toml"), "-o", file("x.exr"), "--res", "8x8",
                           "--spp", "1"}),
               0, {"noise unknown (it takes two samples a pixel)"});
}

TEST_F(Render, FireIsSeenInAPicture) {
    const std::string fire =
        "[[volume]]\nbox = { min = [-0.5, -0.5, -0.5], max = [0.5, 0.5, 0.5] }\nsigma_a = 0\n"
        "sigma_s = 0\nemission = [1, 0.5, 0.2]\n[[light]]\ntype = \"sun\"\nelevation = 30\n"
        "[camera]\ntype = \"orthographic\"\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\nheight = 3\n";
    const ProgramResult result = renderScene(fire, {"-o", file("f.png"), "-o", file("f.webp"), "-o",
                                                    file("f.tif"), "--view", "Standard"});
    expectSaid(result, 0,
               {"f.png: ", "of the pixels emit more light than their alpha covers, as fire does"});
    const ReadBack exr = readBack(dir / "out.exr");
    EXPECT_NEAR(exr.at(8, 4, "G"), 0.5, 0.01);
    EXPECT_EQ(exr.at(8, 4, "A"), 0.0f);
    const ReadBack png = readBack(dir / "f.png");
    EXPECT_EQ(png.at(8, 4, "R"), 255.0f);
    EXPECT_NEAR(png.at(8, 4, "G"), 188, 2);  // 0.5
    EXPECT_EQ(readBack(dir / "f.png").at(8, 4, "A"), 255.0f);
    EXPECT_EQ(readBack(dir / "f.png").at(0, 0, "A"), 0.0f);
    EXPECT_EQ(readBack(dir / "f.tif").at(8, 4, "A"), 1.0f);
}

TEST_F(Render, SkiesThatSetHidesGivePicturesAlpha) {
    EXPECT_EQ(render({"smoke.vdb"}, {"-o", file("x.png")}).exitCode, 0);
    EXPECT_EQ(readBack(dir / "x.png").channels.size(), 3u);
    const ProgramResult hidden =
        render({"smoke.vdb"}, {"-o", file("x.png"), "--set", "light[1].visible=false"});
    expectSaid(hidden, 0, {"changed as --set says"});
    EXPECT_EQ(readBack(dir / "x.png").channels.size(), 4u);
}

TEST_F(Render, TheSunIsMovedByEveryWayAlike) {
    const auto digest = [&](const std::string& input, Words options) {
        for (const char* word : {"-o", "x.exr", "--stats", "s.json", "--quiet"})
            options.emplace_back(word[0] == '-' ? word : file(word));
        const ProgramResult result = render({input}, options);
        EXPECT_EQ(result.exitCode, 0) << result.err;
        return nlohmann::json::parse(readText(file("s.json"))).at("scene_digest");
    };
    const auto chosen = digest("smoke.vdb", {});
    const auto moved = digest("smoke.vdb", {"--set", "light[0].azimuth=200"});
    EXPECT_NE(moved, chosen);
    EXPECT_EQ(render({"smoke.vdb"}, {"--write-scene", file("saved.toml")}).exitCode, 0);
    EXPECT_EQ(digest("saved.toml", {}), chosen);
    EXPECT_EQ(digest("saved.toml", {"--set", "light[0].azimuth=200"}), moved);
    EXPECT_EQ(digest("smoke.vdb", {"--sun", "40,200"}), moved);
    EXPECT_EQ(digest("saved.toml", {"--sun", "+40,+200"}), moved);
}

TEST_F(Render, TheSunThatIsThereIsMoved) {
    const auto sunOf = [&](const std::string& lights, const std::string& angles) {
        writeText(dir / "lit.toml", "[[volume]]\nfile = \"smoke.vdb\"\n" + lights);
        const ProgramResult result =
            render({"lit.toml"}, {"--sun", angles, "--write-scene", file("moved.toml")});
        EXPECT_EQ(result.exitCode, 0) << result.err;
        const SceneDescription scene = parseScene(dir / "moved.toml");
        for (const LightDescription& light : scene.lights)
            if (const auto* sun = std::get_if<SunDescription>(&light.light))
                return sun->place.value();
        return SunPlace{};
    };
    const std::string sky = "[[light]]\ntype = \"environment\"\n";
    const std::string sun = "[[light]]\ntype = \"sun\"\ndirection = [0, -1, 0]\n";
    EXPECT_EQ(sunOf(sky + sun, "10,20"), (SunPlace{10, 20, UpAxis::Y}));
    EXPECT_EQ(sunOf(sun + "[camera]\nup = [0, 0, 1]\n", "10,20"), (SunPlace{10, 20, UpAxis::Z}));
    writeText(dir / "lit.toml", "[[volume]]\nfile = \"smoke.vdb\"\n" + sky);
    expectSaid(render({"lit.toml"}, {"-o", file("x.exr"), "--sun", "1,2"}), 2,
               {"--sun: the scene has no sun"});
    for (const char* wrong : {"40", "91,0", "40;10", "a,b", "40,"})
        expectSaid(render({"smoke.vdb"}, {"-o", file("x.exr"), "--sun", wrong}), 2,
                   {"--sun: '", "expected ELEVATION,AZIMUTH"});
}

TEST_F(Render, FramesOfASequenceShareAllChoices) {
    for (int frame = 9; frame < 12; ++frame) {
        GridSpec grid = cube();
        grid.box.upper.y = frame;  // the last file is the largest
        writeVdb(dir / fmt::format("fire.{:04}.vdb", frame), {grid});
    }
    const auto scene = [&](const std::string& name, const Words& more = {}) {
        Words all{"--write-scene", file("saved.toml")};
        all.insert(all.end(), more.begin(), more.end());
        const ProgramResult result = render({name}, all);
        EXPECT_EQ(result.exitCode, 0) << result.err;
        std::string text = readText(file("saved.toml"));
        const auto at = text.find(name);
        EXPECT_NE(at, text.npos) << text;
        return std::pair(text.replace(at, name.size(), "FILE"), result.err);
    };
    const auto [first, said] = scene("fire.0009.vdb");
    EXPECT_EQ(first, scene("fire.0010.vdb").first);
    EXPECT_EQ(first, scene("fire.0011.vdb").first);
    EXPECT_NE(said.find("chosen from its largest file"), said.npos) << said;
    EXPECT_NE(first, scene("fire.0009.vdb", {"--plain"}).first);
    // Two files are no sequence.
    fs::remove(dir / "fire.0011.vdb");
    EXPECT_NE(scene("fire.0009.vdb").first, scene("fire.0010.vdb").first);
}

TEST_F(Render, AnExposureIsChosenForPicturesOnly) {
    const auto exposure = [&](const Words& options) {
        const ProgramResult result = render({"smoke.vdb"}, options);
        EXPECT_EQ(result.exitCode, 0) << result.err;
        const auto at = result.err.find("\nexposure = ");
        return at == result.err.npos
                   ? std::string("none")
                   : result.err.substr(at + 12, result.err.find('\n', at + 1) - at - 12);
    };
    const std::string chosen = exposure({"-o", file("a.png")});
    EXPECT_NE(chosen, "none");
    EXPECT_EQ(exposure({"-o", file("a.exr")}), "none");
    EXPECT_EQ(exposure({"-o", file("d.png"), "--plain"}), "none");
    EXPECT_EQ(exposure({"-o", file("d.png"), "--exposure", "0"}), "none");
    // What is printed makes the same picture, as the saved scene does.
    EXPECT_EQ(exposure({"-o", file("b.png"), "--exposure", chosen}), "none");
    EXPECT_EQ(readBack(dir / "b.png").values, readBack(dir / "a.png").values);
    render({"smoke.vdb"}, {"--write-scene", file("saved.toml")});
    render({"saved.toml"}, {"-o", file("c.png")});
    EXPECT_EQ(readBack(dir / "c.png").values, readBack(dir / "a.png").values);
}

TEST_F(Render, OrbitTurnsTheCamera) {
    const auto eye = [&](const std::string& input, const std::string& degrees) {
        const ProgramResult result =
            render({input}, {"--orbit", degrees, "--write-scene", file("turned.toml")});
        EXPECT_EQ(result.exitCode, 0) << result.err;
        return std::get<LookAt>(*parseScene(dir / "turned.toml").camera.pose).eye;
    };
    writeText(dir / "seen.toml",
              "[[volume]]\nfile = \"smoke.vdb\"\n"
              "[camera]\neye = [0, 0, 9]\nlook_at = [0, 0, 0]\n");
    EXPECT_LT(length(eye("seen.toml", "+90") - Vec3d{9, 0, 0}), 1e-9);
    EXPECT_LT(length(eye("seen.toml", "-90") - Vec3d{-9, 0, 0}), 1e-9);
    const Vec3d middle{7.5, 7.5, 7.5}, a = eye("smoke.vdb", "0"), b = eye("smoke.vdb", "180");
    EXPECT_NEAR(a.x - middle.x, middle.x - b.x, 0.1);
    EXPECT_NEAR(a.z - middle.z, middle.z - b.z, 0.1);
}

TEST_F(Render, TheShutterIsThatOfTheCommandLine) {
    const auto shutter = [&](const std::string& text) {
        const ProgramResult result =
            render({"smoke.vdb"}, {"--shutter", text, "--write-scene", file("open.toml")});
        EXPECT_EQ(result.exitCode, 0) << result.err;
        return parseScene(dir / "open.toml").camera.shutter;
    };
    EXPECT_EQ(shutter("0.5"), (camera::Shutter{-0.25, 0.25}));
    EXPECT_EQ(shutter("0,0.75"), (camera::Shutter{0, 0.75}));
    EXPECT_EQ(shutter("-1,-0.5"), (camera::Shutter{-1, -0.5}));
    for (const auto& [text, told] : std::vector<std::pair<std::string, std::string>>{
             {"0.5,-0.5",
              "--shutter: '0.5,-0.5' closes before it opens; expected OPEN,CLOSE such as "
              "-0.25,0.25"},
             {"-1", "--shutter: '-1' is not a number from 0 to 1000"},
             {"1,2,3", "--shutter: '2,3'"}}) {
        const ProgramResult wrong =
            render({"smoke.vdb"}, {"--shutter", text, "--write-scene", file("open.toml")});
        EXPECT_EQ(wrong.exitCode, 2);
        EXPECT_NE(wrong.err.find(told), std::string::npos) << wrong.err;
    }
}

TEST_F(Render, LayersAreThoseOfTheSceneOrOfTheCommandLine) {
    const std::string scene =
        "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nsigma_s = 1\n"
        "emission = 1\ngroup = \"fire\"\n"
        "[[light]]\ntype = \"sun\"\nelevation = 40\ngroup = \"key\"\n"
        "[output]\nlayers = \"lightgroups\"\n";
    const auto channels = [&](const Words& more) {
        EXPECT_EQ(renderScene(scene, more).exitCode, 0);
        const Words all = readBack(dir / "out.exr").channels;
        return std::set<std::string>(all.begin(), all.end());
    };
    const std::set<std::string> rgba{"R", "G", "B", "A"};
    std::set<std::string> groups = rgba;
    for (const char* group : {"rest", "fire", "key"})
        for (const char* channel : {"R", "G", "B"})
            groups.insert(fmt::format("lightgroup_{}.{}", group, channel));
    EXPECT_EQ(channels({}), groups);
    EXPECT_EQ(channels({"--layers", "default"}), rgba);
    EXPECT_EQ(channels({"--layers", "samples"}),
              (std::set<std::string>{"R", "G", "B", "A", "samples"}));
    std::set<std::string> all = groups;
    for (const image::Layer& layer : image::layerTable())
        all.insert(layer.channels.begin(), layer.channels.end());
    EXPECT_EQ(channels({"--layers", "all"}), all);
    // Parts of their own say the same numbers.
    const ReadBack together = readBack(dir / "out.exr");
    EXPECT_EQ(channels({"--layers", "all", "--multipart"}), rgba);
    const ReadBack position = readBack(dir / "out.exr", 6);
    EXPECT_EQ(position.attributes.at("oiio:subimagename"), "position");
    EXPECT_EQ(position.at(8, 4, "X"), together.at(8, 4, "position.X"));
    EXPECT_EQ(together.types.at("emission.R"), "float");
    channels({"--layers", "emission:half,depth", "--half"});
    EXPECT_EQ(readBack(dir / "out.exr").types.at("emission.R"), "half");
    EXPECT_EQ(readBack(dir / "out.exr").types.at("Z"), "float");
    expectSaid(renderScene(scene, {"--layers", "lightgroup_fier"}), 2,
               {"--layers: the scene has no light group", "did you mean 'lightgroup_fire'?"});
    expectSaid(renderScene(scene, {"--set", "light[0].group=emission"}), 3,
               {"light[0].group is 'emission', which is the name of a layer"});
}

TEST_F(Render, HeadersSayWhereTheCameraStands) {
    const std::string scene =
        "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nsigma_s = 1\n"
        "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n";
    EXPECT_EQ(renderScene(scene).exitCode, 0);
    auto attributes = readBack(dir / "out.exr").attributes;
    EXPECT_EQ(attributes.at("worldToCamera"), "1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 5, 1");
    EXPECT_TRUE(attributes.contains("worldToNDC"));
    EXPECT_EQ(attributes.at("colorInteropID"), "lin_rec709_scene");
    EXPECT_FALSE(attributes.contains("framesPerSecond"));
    EXPECT_EQ(renderScene(scene + "shutter = 0.5\n[render]\nfps = 23.976\n").exitCode, 0);
    attributes = readBack(dir / "out.exr").attributes;
    EXPECT_EQ(attributes.at("framesPerSecond"), "24000/1001");
    EXPECT_EQ(attributes.at("shutterAngle"), "180");
}

TEST_F(Render, SmallNumbersAndWordsAreTaken) {
    const auto picture = [&](const Words& options) {
        Words all{"-o", file("x.png")};
        all.insert(all.end(), options.begin(), options.end());
        const ProgramResult result = render({"smoke.vdb"}, all);
        EXPECT_EQ(result.exitCode, 0) << result.err;
        return readBack(dir / "x.png").values;
    };
    const auto brighter = picture({"--exposure", "1"});
    EXPECT_EQ(picture({"--exposure=+1"}), brighter);
    EXPECT_EQ(picture({"--exposure", "+1"}), brighter);
    EXPECT_NE(picture({"--exposure", "-1"}), brighter);
    EXPECT_EQ(picture({"--look", "none"}), picture({}));  // the views that come along have none
    EXPECT_EQ(picture({"--look", "None"}), picture({}));
    expectSaid(render({"smoke.vdb"}, {"-o", file("x.png"), "--exposure=+-1"}), 2,
               {"'+-1' is not a number"});
}

TEST_F(Render, FoldersOfOutputsAreMadeWhereAskedFor) {
    const Words outputs{
        "-o", file("new/a/x.png"), "--stats", file("st/s.js"), "--write-scene", file("sc/s.toml")};
    expectSaid(render({"smoke.vdb"}, outputs), 2, {"there is no directory", "give --mkdir"});
    EXPECT_EQ(files(), 1u);
    Words made = outputs;
    made.push_back("--mkdir");
    EXPECT_EQ(render({"smoke.vdb"}, made).exitCode, 0);
    for (const char* name : {"new/a/x.png", "st/s.js", "sc/s.toml"})
        EXPECT_TRUE(fs::exists(dir / name)) << name;
    writeText(dir / "file", "");
    expectSaid(render({"smoke.vdb"}, {"-o", file("file/b/x.png"), "--mkdir"}), 2,
               {"cannot make the directory"});
    // Of other commands.
    for (const Words& command :
         {Words{"convert", file("smoke.vdb"), file("c/smoke.npy"), "--quiet"},
          Words{"bake", "turbulent_sphere", "--resolution", "8", "-o", file("b/x.vdb"), "-q"}}) {
        expectSaid(runProgram(command), 2, {"there is no directory", "give --mkdir"});
        Words with = command;
        with.push_back("--mkdir");
        EXPECT_EQ(runProgram(with).exitCode, 0) << command.front();
    }
}

TEST_F(Render, ASavedSceneSaysWhatWasChosen) {
    expectSaid(
        render({"smoke.vdb"}, {"--write-scene", file("s.toml")}), 0,
        {"s.toml: the scene with every value that it uses. Chosen were the grid 'density' of "
         "smoke.vdb, its density scale ",
         "a camera that frames what is there", "a sun 40 degrees high at azimuth ",
         "a graded backdrop", "a fill that is not seen", "an exposure of ", "--set"});
    expectSaid(render({"s.toml"}, {"--write-scene", file("t.toml")}), 0,
               {"nothing was left to choose"});
}

TEST_F(Render, WhatASceneDoesNotUseIsNoNews) {
    const ProgramResult plain = render({"smoke.vdb"}, {"-o", file("x.exr")});
    expectSaid(plain, 0, {"info: the scene uses scattering, light sampling\n"});
    expectNotSaid(plain, "emission");
    expectSaid(render({"smoke.vdb"}, {"-o", file("x.exr"), "--log-level", "debug"}), 0,
               {"does not need three colour channels, overlapping media, emission"});
}

TEST_F(Render, NothingThatSetNamesIsWrittenOver) {
    writeFloats(dir / "sky.exr", 4, 2, 3, std::vector<float>(24, 1.0f));
    const std::string before = readText(file("sky.exr"));
    expectSaid(render({"smoke.vdb"},
                      {"-o", file("sky.exr"), "--set", "light[1].image=" + file("sky.exr")}),
               2, {"an input and an output"});
    EXPECT_EQ(readText(file("sky.exr")), before);
    EXPECT_EQ(
        render({"smoke.vdb"}, {"-o", file("x.exr"), "--set", "light[1].image=" + file("sky.exr"),
                               "--set", "light[0].irradiance=0"})
            .exitCode,
        0);
    EXPECT_NEAR(readBack(dir / "x.exr").at(0, 0, "R"), 0.075, 1e-3);  // the sky's radiance x 1
}

}  // namespace
}  // namespace woodcock::test
