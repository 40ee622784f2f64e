// SPDX-License-Identifier: Apache-2.0
#include "woodcock/woodcock.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/environment_variable.h"
#include "tests/support/expect_error.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "woodcock/proof/support/read_back.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace proof;

namespace {

/// Larger than a leaf along x, no multiple of one, and different along each axis.
constexpr std::array<int, 3> size{19, 10, 7};
float densityAt(int x, int y, int z) {
    return x < 12 && y > 4 ? 0.0f : 0.31f + 0.07f * float(x) + 0.013f * float(y * z);
}

std::vector<float> density() {
    std::vector<float> values;
    for (int z = 0; z < size[2]; ++z)
        for (int y = 0; y < size[1]; ++y)
            for (int x = 0; x < size[0]; ++x) values.push_back(densityAt(x, y, z));
    return values;
}

void writeDensity(const std::filesystem::path& file) {
    GridSpec grid;
    grid.box = {{0, 0, 0}, {size[0] - 1, size[1] - 1, size[2] - 1}};
    grid.value = [](Vec3i p) { return double{densityAt(p.x, p.y, p.z)}; };
    grid.worldFromIndex = {{Vec3d{0.25, 0, 0}, {0, 0.25, 0}, {0, 0, 0.25}}, {1, 2, -3}};
    writeVdb(file, {grid});
}

const std::string scene = R"(
[[volume]]
file = "smoke.vdb"
scale = 3
albedo = [0.9, 0.8, 0.7]
g = 0.4
)";

void setSmall(Renderer& renderer) {
    renderer.setResolution(24, 16);
    renderer.setSamples(3);
    renderer.setSeed(7);
}

std::vector<float> pixelsOf(const Renderer& renderer) {
    const RenderedImage image = renderer.render();
    EXPECT_EQ(image.pixels().size(), std::size_t(image.width()) * std::size_t(image.height()) * 4);
    return {image.pixels().begin(), image.pixels().end()};
}

std::vector<float> pixelsOf(const std::filesystem::path& exr) {
    const ReadBack image = readBack(exr);
    std::vector<float> pixels;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (const char* channel : {"R", "G", "B", "A"})
                pixels.push_back(image.at(x, y, channel));
    return pixels;
}

bool isBlack(const std::vector<float>& pixels) {
    return std::all_of(pixels.begin(), pixels.end(), [](float v) { return v == 0; });
}

/// A folder that holds smoke.vdb, and scene.toml around it.
class Door : public testing::Test {
protected:
    void SetUp() override {
        writeDensity(dir / "smoke.vdb");
        writeText(dir / "scene.toml", scene);
    }

    std::filesystem::path drawnByProgram(const std::string& input) const {
        const std::filesystem::path exr = dir / "program.exr";
        const ProgramResult result = runProgram({"render", (dir / input).string(), "--res", "24x16",
                                                 "--spp", "3", "--seed", "7", "-o", exr.string()});
        EXPECT_EQ(result.exitCode, 0) << result.err;
        return exr;
    }

    TempDir dir;
};

TEST_F(Door, GivesTheBitsOfTheProgram) {
    for (const char* input : {"scene.toml", "smoke.vdb"}) {
        Renderer renderer = Renderer::open(dir / input);
        setSmall(renderer);
        const std::vector<float> pixels = pixelsOf(renderer);
        EXPECT_FALSE(isBlack(pixels));
        EXPECT_EQ(pixels, pixelsOf(drawnByProgram(input))) << input;
    }
}

TEST_F(Door, WritesWhatTheProgramWrites) {
    Renderer renderer = Renderer::open(dir / "scene.toml");
    setSmall(renderer);
    const RenderedImage image = renderer.render();
    image.write(dir / "door.exr");
    const std::filesystem::path program = drawnByProgram("scene.toml");
    EXPECT_EQ(pixelsOf(dir / "door.exr"), pixelsOf(program));
    image.write(dir / "door.png");
    EXPECT_GT(std::filesystem::file_size(dir / "door.png"), 0u);
    expectError(ErrorKind::Usage, "xyz", [&] { image.write(dir / "door.xyz"); });
}

TEST_F(Door, DenoisesWhereTheSceneSaysSo) {
    Renderer renderer = Renderer::open(dir / "scene.toml");
    setSmall(renderer);
    renderer.set("render.denoise", "true");
    {
        const EnvironmentVariable library("WOODCOCK_OIDN", fakeOidn().string());
        const RenderedImage image = renderer.render();
        image.write(dir / "a.exr");
        const ReadBack written = readBack(dir / "a.exr");
        bool differs = false;
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) {
                const auto i = 4 * (std::size_t(y) * std::size_t(image.width()) + std::size_t(x));
                EXPECT_EQ(image.pixels()[i], written.at(x, y, "R"));
                differs |= image.pixels()[i] != written.at(x, y, "noisy.R");
            }
        EXPECT_TRUE(differs);
    }
    const EnvironmentVariable none("WOODCOCK_OIDN", (dir / "none").string());
    expectError(ErrorKind::Usage, "which is not there", [&] { renderer.render(); });
}

TEST_F(Door, TakesAnArrayAsAFileOfTheSameVolume) {
    const std::vector<float> values = density();
    Renderer array;
    EXPECT_EQ(array.addVolume({.size = size,
                               .density = values,
                               .voxelSize = 0.25,
                               .origin = {1, 2, -3},
                               .scale = 3,
                               .albedo = {0.9, 0.8, 0.7},
                               .g = 0.4}),
              0);
    setSmall(array);
    Renderer file = Renderer::open(dir / "scene.toml");
    setSmall(file);
    const std::vector<float> expected = pixelsOf(file);
    EXPECT_EQ(pixelsOf(array), expected);

    Renderer beside = Renderer::fromText(scene, dir.path());
    beside.addVolume({.size = size, .density = values, .voxelSize = 0.25, .scale = 3});
    setSmall(beside);
    EXPECT_NE(pixelsOf(beside), expected);
}

TEST_F(Door, TakesThePhaseFunctionsOfASceneFile) {
    const std::vector<float> values = density();
    LatticeVolume volume{.size = size,
                         .density = values,
                         .voxelSize = 0.25,
                         .origin = {1, 2, -3},
                         .scale = 3,
                         .albedo = {0.9, 0.8, 0.7}};
    for (const std::string phase :
         {"{ type = \"mie\", diameter = 20 }", "{ type = \"rayleigh\" }"}) {
        volume.phase = phase;
        Renderer array;
        array.addVolume(volume);
        setSmall(array);
        Renderer file = Renderer::open(dir / "scene.toml");
        file.set("volume[0].phase", phase);
        setSmall(file);
        EXPECT_EQ(pixelsOf(array), pixelsOf(file)) << phase;
    }
}

TEST_F(Door, RefusesWhatIsNoPhaseFunction) {
    const std::vector<float> values = density();
    const auto refused = [&](const std::string& phase, double g, const char* part) {
        Renderer renderer;
        expectError(ErrorKind::Input, part, [&] {
            renderer.addVolume({.size = size, .density = values, .g = g, .phase = phase});
        });
        expectError(ErrorKind::Usage, "empty", [&] { renderer.render(); });
    };
    refused("{ type = \"mia\" }", 0, "mie");
    refused("{ type = \"mie\", diameter = -1 }", 0, "diameter");
    refused("{ type = \"rayleigh\" }", 0.5, "both say how the volume scatters");
    for (const char* text :
         {"rayleigh", "\"rayleigh\"", "{ type = \"rayleigh\" }\nstorage = \"half\"",
          "{ type = \"rayleigh\"", "{ type = \"rayleigh\" }\n[[light]]"})
        refused(text, 0, "written as in a scene file");
}

TEST_F(Door, ChoosesAScaleForAnArrayAsForAFile) {
    const std::vector<float> values = density();
    Renderer array;
    array.addVolume({.size = size,
                     .density = values,
                     .voxelSize = 0.25,
                     .origin = {1, 2, -3},
                     .albedo = {0.97, 0.97, 0.97}});  // as that of files that stand alone
    setSmall(array);
    Renderer file = Renderer::open(dir / "smoke.vdb");
    setSmall(file);
    EXPECT_EQ(pixelsOf(array), pixelsOf(file));
}

TEST_F(Door, ChangesTheScene) {
    Renderer renderer = Renderer::open(dir / "scene.toml");
    setSmall(renderer);
    EXPECT_EQ(renderer.width(), 24);
    EXPECT_EQ(renderer.height(), 16);
    EXPECT_EQ(renderer.samples(), 3);
    EXPECT_EQ(renderer.seed(), 7u);
    const std::vector<float> before = pixelsOf(renderer);
    renderer.set("volume[0].scale", "1");
    const std::vector<float> thinner = pixelsOf(renderer);
    EXPECT_NE(thinner, before);
    renderer.placeCamera({3, 3, 6}, {3, 3, -2});
    const std::vector<float> moved = pixelsOf(renderer);
    EXPECT_NE(moved, thinner);
    renderer.set("volume[0].scale", "3");
    EXPECT_NE(pixelsOf(renderer), moved);

    Renderer placed = Renderer::open(dir / "scene.toml");
    setSmall(placed);
    placed.set("camera.eye", "[3, 3, 6]");
    placed.set("camera.look_at", "[3, 3, -2]");
    EXPECT_EQ(pixelsOf(placed), pixelsOf(renderer));
}

TEST_F(Door, StaysAsItWasAfterAMistake) {
    Renderer renderer = Renderer::open(dir / "scene.toml");
    setSmall(renderer);
    const std::vector<float> before = pixelsOf(renderer);
    expectError(ErrorKind::Input, "render.spp", [&] { renderer.setSamples(0); });
    expectError(ErrorKind::Input, "colour", [&] { renderer.set("volume[0].colour", "1"); });
    expectError(ErrorKind::Usage, "up", [&] { renderer.placeCamera({0, 0, 0}, {0, 1, 0}); });
    const std::vector<float> values = density();
    expectError(ErrorKind::Input, "albedo", [&] {
        renderer.addVolume({.size = size, .density = values, .albedo = {2, 1, 1}});
    });
    EXPECT_EQ(pixelsOf(renderer), before);
}

TEST_F(Door, RefusesArraysThatAreNoDensity) {
    std::vector<float> values = density();
    Renderer renderer;
    expectError(ErrorKind::Usage, "1330", [&] {
        renderer.addVolume({.size = {19, 10, 8}, .density = values});
    });
    expectError(ErrorKind::Usage, "points", [&] { renderer.addVolume({}); });
    expectError(ErrorKind::Input, "voxels of 0",
                [&] { renderer.addVolume({.size = size, .density = values, .voxelSize = 0}); });
    values[5] = -1;
    expectError(ErrorKind::Input, "1 negative voxel (first at [5, 0, 0])",
                [&] { renderer.addVolume({.size = size, .density = values}); });
    values[5] = NAN;
    expectError(ErrorKind::Input, "NaN",
                [&] { renderer.addVolume({.size = size, .density = values}); });
    expectError(ErrorKind::Usage, "empty", [&] { renderer.render(); });

    values[5] = 1;
    renderer.addVolume({.size = size, .density = values});
    setSmall(renderer);
    renderer.set("volume[0].emission", "1");
    expectError(ErrorKind::Usage, "density alone", [&] { renderer.render(); });
}

TEST_F(Door, SaysWhatCannotBeOpened) {
    expectError(ErrorKind::Input, "missing.toml", [&] { Renderer::open(dir / "missing.toml"); });
    writeText(dir / "wrong.toml", "[[volume]]\nfile = \"smoke.vdb\"\ng = 2\n");
    expectError(ErrorKind::Input, "wrong.toml:3", [&] { Renderer::open(dir / "wrong.toml"); });
    const Renderer missing = Renderer::open(dir / "missing.vdb");
    expectError(ErrorKind::Input, "missing.vdb", [&] { missing.render(); });
}

TEST_F(Door, TellsOfTheRenderAndStops) {
    Renderer renderer = Renderer::open(dir / "scene.toml");
    setSmall(renderer);
    double last = 0;
    const RenderedImage whole =
        renderer.render({.progress = [&](const RenderState& now) { last = now.fraction; }});
    EXPECT_TRUE(whole.complete());
    EXPECT_EQ(whole.samples(), 3);
    EXPECT_EQ(last, 1);
    EXPECT_FALSE(whole.notes().empty());

    renderer.setSamples(1000000);
    const RenderedImage stopped = renderer.render({.stop = [] { return true; }});
    EXPECT_FALSE(stopped.complete());
    EXPECT_LT(stopped.samples(), 1000000);
}

}  // namespace
}  // namespace woodcock::test
