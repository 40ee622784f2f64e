// SPDX-License-Identifier: Apache-2.0
// Mattes and deep pixels as files: read by programs that share nothing with what writes them.
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/decode_cryptomatte.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/proof/support/read_back.h"

namespace woodcock::test {

using namespace proof;

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

// A glowing, absorbing box before a wall: what is in front of any depth does not depend on what
// stands behind it.
const std::string medium =
    "[[volume]]\nname = \"haze\"\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\n"
    "sigma_a = 0.7\nsigma_s = 0\nemission = [1, 0.5, 0.2]\n";
const std::string wall =
    "[[surface]]\nname = \"wall\"\nmaterial = \"grey\"\n"
    "box = { min = [-0.6, -0.6, -0.5], max = [0.6, 0.6, 0.25] }\n"
    "[[material]]\nname = \"grey\"\ntype = \"emissive\"\nradiance = 0.4\n";
const std::string rest =
    "[[light]]\ntype = \"environment\"\nradiance = 0\nvisible = false\n"
    "[camera]\neye = [0.5, 0.8, 6]\nlook_at = [0, 0, 0]\nfov = 25\n"
    "[render]\nresolution = [24, 16]\nspp = 256\n";

class Compositing : public testing::Test {
protected:
    std::string file(const std::string& name) const { return (dir / name).string(); }
    ProgramResult render(const std::string& scene, const Words& more) const {
        writeWholeFile(dir / "scene.toml", scene + rest);
        Words all{"render", file("scene.toml"), "--threads", "2", "--quiet"};
        all.insert(all.end(), more.begin(), more.end());
        return runProgram(all);
    }
    void expectRefused(const std::string& scene, const Words& more, const std::string& said,
                       int exitCode = 2) const {
        const ProgramResult result = render(scene, more);
        EXPECT_EQ(result.exitCode, exitCode) << result.err;
        EXPECT_NE(result.err.find(said), std::string::npos)
            << "says:     " << result.err << "expected: " << said;
        for (const fs::directory_entry& entry : fs::directory_iterator(dir.path()))
            EXPECT_EQ(entry.path().filename(), "scene.toml");
    }
    OIIO::ImageBuf flattened(const OIIO::ImageBuf& deep) const {
        OIIO::ImageBuf flat = OIIO::ImageBufAlgo::flatten(deep);
        EXPECT_FALSE(flat.has_error()) << flat.geterror();
        return flat;
    }

    const TempDir dir;
};

float valueOf(const OIIO::ImageBuf& image, int x, int y, const std::string& channel) {
    const auto& names = image.spec().channelnames;
    const auto found = std::find(names.begin(), names.end(), channel);
    EXPECT_NE(found, names.end()) << channel;
    return image.getchannel(x, y, 0, static_cast<int>(found - names.begin()));
}

TEST_F(Compositing, OpenImageIoFlattensDeepPixelsToThePicture) {
    const ProgramResult result =
        render(medium + wall, {"-o", file("a.exr"), "--deep", file("deep.exr")});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    OIIO::ImageBuf deep(file("deep.exr"));
    ASSERT_TRUE(deep.read(0, 0, true)) << deep.geterror();
    ASSERT_TRUE(deep.deep());
    const OIIO::ImageSpec& spec = deep.spec();
    Words channels = spec.channelnames;
    std::sort(channels.begin(), channels.end());
    EXPECT_EQ(channels, (Words{"A", "B", "G", "R", "Z", "ZBack"}));
    EXPECT_EQ(spec.get_string_attribute("woodcock/deepDepth"),
              "Z and ZBack are along the camera's axis, in world units");
    EXPECT_FLOAT_EQ(spec.get_float_attribute("woodcock/deepError"), 0.01f);

    const OIIO::ImageBuf flat = flattened(deep);
    const ReadBack picture = readBack(dir / "a.exr");
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 24; ++x)
            for (const char* channel : {"R", "G", "B", "A"})
                EXPECT_NEAR(valueOf(flat, x, y, channel), picture.at(x, y, channel), 3e-6)
                    << x << ", " << y << " " << channel;
}

TEST_F(Compositing, AVolumeAndASurfaceMergeToTheSceneOfBoth) {
    ASSERT_EQ(render(medium, {"--deep", file("medium.exr")}).exitCode, 0);
    ASSERT_EQ(render(wall, {"--deep", file("wall.exr")}).exitCode, 0);
    ASSERT_EQ(render(medium + wall, {"-o", file("both.exr")}).exitCode, 0);
    OIIO::ImageBuf a(file("medium.exr")), b(file("wall.exr"));
    ASSERT_TRUE(a.read(0, 0, true) && b.read(0, 0, true));
    const OIIO::ImageBuf merged = OIIO::ImageBufAlgo::deep_merge(a, b);
    ASSERT_FALSE(merged.has_error()) << merged.geterror();
    const OIIO::ImageBuf flat = flattened(merged);
    const ReadBack both = readBack(dir / "both.exr");
    double most = 0;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 24; ++x) {
            // Alpha of media that absorb is exact, but for the wall's slanted faces and edges.
            most = std::max(most, double{std::abs(valueOf(flat, x, y, "A") - both.at(x, y, "A"))});
            EXPECT_NEAR(valueOf(flat, x, y, "R"), both.at(x, y, "R"), 0.12) << x << ", " << y;
        }
    EXPECT_LT(most, 0.03);
}

TEST_F(Compositing, MattesAreDecodedByTheSpecificationAlone) {
    const ProgramResult result =
        render(medium + wall,
               {"-o", file("a.exr"), "--mattes", "object,material", "--half", "--layers", "depth"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const ReadBack image = readBack(dir / "a.exr");
    EXPECT_EQ(image.types.at("R"), "half");
    for (const auto& [channel, type] : image.types)
        if (channel.starts_with("Crypto")) {
            EXPECT_EQ(type, "float") << channel;
        }
    const CryptomatteDecoder objects(image, "CryptoObject"), materials(image, "CryptoMaterial");
    EXPECT_EQ(objects.prefix(), "cryptomatte/3ae39a5/");
    EXPECT_EQ(objects.ids().size(), 2u);
    EXPECT_EQ(materials.ids().size(), 2u);
    for (const auto& [name, id] : objects.ids())
        EXPECT_EQ(std::bit_cast<std::uint32_t>(id), murmur3(name));
    bool hazeAlone = false, both = false;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 24; ++x) {
            EXPECT_NEAR(objects.total(x, y), image.at(x, y, "A"), 1e-3);  // which is a half
            EXPECT_NEAR(materials.coverage(x, y, "grey"), objects.coverage(x, y, "wall"), 1e-6);
            EXPECT_NEAR(materials.coverage(x, y, "haze"), objects.coverage(x, y, "haze"), 1e-6);
            hazeAlone |=
                objects.coverage(x, y, "haze") > 0.5 && objects.coverage(x, y, "wall") == 0;
            both |= objects.coverage(x, y, "haze") > 0.2 && objects.coverage(x, y, "wall") > 0.2;
        }
    EXPECT_TRUE(hazeAlone && both);
}

TEST_F(Compositing, MattesMayHaveAFileOfTheirOwn) {
    ASSERT_EQ(render(medium, {"-o", file("a.png"), "-o", file("a.exr"), "--mattes", "object",
                              "--mattes-file", file("m.exr")})
                  .exitCode,
              0);
    EXPECT_FALSE(readBack(dir / "a.exr").has("CryptoObject00.r"));
    const ReadBack mattes = readBack(dir / "m.exr"), picture = readBack(dir / "a.exr");
    const CryptomatteDecoder decoder(mattes, "CryptoObject");
    EXPECT_NEAR(decoder.coverage(12, 8, "haze"), picture.at(12, 8, "A"), 1e-6);
}

TEST_F(Compositing, ASceneFileMayAskForBoth) {
    const std::string output =
        "[output]\nmattes = [\"object\"]\nmattes_file = \"m.exr\"\n"
        "deep = \"d.exr\"\ndeep_error = 0.1\n";
    const ProgramResult result = render(medium + output, {});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_TRUE(fs::exists(dir / "m.exr") && fs::exists(dir / "d.exr"));
}

TEST_F(Compositing, OutputsThatCannotHoldThemAreRefused) {
    expectRefused(medium, {"-o", file("a.png"), "--mattes", "object"}, "--mattes is for EXR files");
    expectRefused(medium + "[output]\nmattes = [\"object\"]\n", {"-o", file("a.png")},
                  "mattes need an EXR file, and no output is one");
    expectRefused(medium, {"-o", file("a.exr"), "--deep", file("d.png")},
                  "--deep: '" + file("d.png") + "' has to be an EXR file");
    expectRefused(medium, {"-o", file("a.exr"), "--deep", file("a.exr")}, "a.exr");
    expectRefused(medium, {"-o", file("a.exr"), "--mattes-file", file("m.exr")},
                  "is for mattes, and none are asked for");
    expectRefused(medium, {"-o", file("a.exr"), "--mattes", "object,objects"},
                  "unknown matte 'objects'; did you mean 'object'?");
    expectRefused(medium, {"-o", file("a.exr"), "--mattes", "object,object"},
                  "--mattes names 'object' twice");
    expectRefused(medium, {"-o", file("a.exr"), "--deep-error", "0.1"}, "give --deep FILE.exr");
    expectRefused(medium + "[output]\ndeep = \"d.jpg\"\n", {"-o", file("a.exr")},
                  "has to be an EXR file", 3);
}

TEST_F(Compositing, EachFrameHasItsFiles) {
    const Words asked{"-o",       file("a.##.exr"), "--deep",        file("d.##.exr"),
                      "--mattes", "object",         "--mattes-file", file("m.##.exr"),
                      "--set",    "render.spp=1",   "--frames",      "1-2"};
    ASSERT_EQ(render(medium, asked).exitCode, 0);
    for (const char* name : {"a", "d", "m"})
        for (const char* frame : {"01", "02"})
            EXPECT_TRUE(fs::exists(dir / fmt::format("{}.{}.exr", name, frame))) << name << frame;
    fs::remove(dir / "d.02.exr");
    Words again = asked;
    again.push_back("--skip-existing");
    ASSERT_EQ(render(medium, again).exitCode, 0);
    EXPECT_TRUE(fs::exists(dir / "d.02.exr"));
}

TEST_F(Compositing, FilesOfFramesNeedAPlaceForTheNumber) {
    expectRefused(medium, {"-o", file("a.##.exr"), "--deep", file("d.exr"), "--frames", "1-2"},
                  "--deep");
    expectRefused(medium,
                  {"-o", file("a.##.exr"), "--mattes", "object", "--mattes-file", file("m.exr"),
                   "--frames", "1-2"},
                  "--mattes-file");
}

TEST_F(Compositing, BiasedQualitiesAreRefused) {
    expectRefused(medium, {"--deep", file("d.exr"), "--set", "render.similarity_after=0"},
                  "deep pixels need the true media on camera rays");
    expectRefused(medium, {"--deep", file("d.exr"), "--set", "render.march_step=0.5"},
                  "Set march_step = 0");
    expectRefused(medium,
                  {"-o", file("a.exr"), "--mattes", "object", "--set", "render.march_step=0.5"},
                  "mattes need tracked rays");
    EXPECT_EQ(
        render(medium, {"-o", file("a.exr"), "--mattes", "object", "--quality", "draft"}).exitCode,
        0);
}

}  // namespace

}  // namespace woodcock::test
