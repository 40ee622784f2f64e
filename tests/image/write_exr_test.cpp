// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/write_exr.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/paths.h"
#include "woodcock/base/error.h"
#include "woodcock/base/version.h"
#include "woodcock/proof/support/read_back.h"

namespace woodcock::test {

using namespace image;
using namespace proof;

namespace {

class WriteExr : public testing::Test {
protected:
    WriteExr() : film_(6, 4, {1, 2, 4, 4}) {
        for (int y = 2; y < 4; ++y)
            for (int x = 1; x < 4; ++x) {
                const float v = static_cast<float>(x) + 0.1f * static_cast<float>(y);
                film_.add(x, y, FilmSample{Rgb(v, 2 * v, 3 * v), 0.25f * static_cast<float>(x)});
            }
        film_.add(1, 2, FilmSample{Rgb(3.2f, 0, 0), 0.75f});
    }

    proof::ReadBack write(const ExrSettings& settings) {
        writeExr(dir_ / "a.exr", film_, metadata_, settings);
        return proof::readBack(dir_ / "a.exr");
    }

    TempDir dir_;
    Film film_;
    RenderMetadata metadata_{16, 80, 0xfedcba9876543210u, 12.5, "digest", "woodcock render a"};
};

TEST_F(WriteExr, KeepsFloatsAndTheCropsPlace) {
    const proof::ReadBack image = write({});
    EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
    EXPECT_EQ(image.x, 1);
    EXPECT_EQ(image.y, 2);
    EXPECT_EQ(image.width, 3);
    EXPECT_EQ(image.height, 2);
    EXPECT_EQ(image.fullWidth, 6);
    EXPECT_EQ(image.fullHeight, 4);
    for (int y = 2; y < 4; ++y)
        for (int x = 1; x < 4; ++x) {
            EXPECT_EQ(image.at(x, y, "R"), film_.radiance(x, y)[0]);
            EXPECT_EQ(image.at(x, y, "G"), film_.radiance(x, y)[1]);
            EXPECT_EQ(image.at(x, y, "B"), film_.radiance(x, y)[2]);
            EXPECT_EQ(image.at(x, y, "A"), film_.alpha(x, y));
        }
    for (const auto& [channel, type] : image.types) EXPECT_EQ(type, "float") << channel;
}

TEST_F(WriteExr, HalfIsForColourAndFinite) {
    film_.add(3, 3, FilmSample{Rgb(1e9f, 0, 0), 1});
    ExrSettings settings;
    settings.half = true;
    settings.layers = layersFromNames({"depth", "error", "albedo"}, {}, true);
    const proof::ReadBack image = write(settings);
    for (const char* channel : {"R", "G", "B", "A", "albedo.R"})
        EXPECT_EQ(image.types.at(channel), "half");
    for (const char* channel : {"Z", "error.R", "error.G", "error.B"})
        EXPECT_EQ(image.types.at(channel), "float");
    EXPECT_EQ(image.at(3, 3, "R"), 65504.0f);
    EXPECT_EQ(image.at(3, 3, "error.R"), film_.standardError(3, 3)[0]);
    EXPECT_NEAR(image.at(2, 2, "G"), 4.4f, 4.4f / 2048);
}

TEST_F(WriteExr, LayersOnRequest) {
    film_.add(2, 3, DepthSample{Rgb(0.5f, 0.25f, 0.125f), 6, 0.5f});
    const proof::ReadBack image =
        write({false, layersFromNames({"samples", "depth", "transmittance", "error"}), {}});
    EXPECT_EQ(image.at(2, 3, "Z"), 12.0f);
    EXPECT_EQ(image.at(1, 3, "Z"), Film::noDepth);
    EXPECT_EQ(image.at(2, 3, "transmittance.R"), 0.5f);
    EXPECT_EQ(image.at(2, 3, "transmittance.G"), 0.25f);
    EXPECT_EQ(image.at(2, 3, "transmittance.B"), 0.125f);
    EXPECT_EQ(image.at(1, 2, "samples"), 2.0f);
    EXPECT_EQ(image.at(2, 2, "samples"), 1.0f);
    // Two samples: half of their distance. Red was 1.2 and 3.2, green 2.4 and 0.
    EXPECT_FLOAT_EQ(image.at(1, 2, "error.R"), 1.0f);
    EXPECT_FLOAT_EQ(image.at(1, 2, "error.G"), 1.2f);
}

TEST_F(WriteExr, LayersForDenoisers) {
    film_ = Film(6, 4, {1, 2, 4, 4}, {.surfaces = false, .features = true});
    film_.add(2, 3, DepthSample{Rgb(0.0f), 1, 1, Rgb(0.5f, 0.25f, 0), {0, 0.5f, -1}});
    for (const float v : {1.0f, 3.0f}) film_.add(2, 3, FilmSample{Rgb(v, 2 * v, 0), 1});
    const proof::ReadBack image =
        write({true, layersFromNames({"albedo", "normal", "error", "variance"}), {}});
    EXPECT_EQ(image.at(2, 3, "albedo.R"), 0.5f);
    EXPECT_EQ(image.at(2, 3, "albedo.G"), 0.25f);
    EXPECT_EQ(image.at(2, 3, "normal.Y"), 0.5f);
    EXPECT_EQ(image.at(2, 3, "normal.Z"), -1.0f);
    EXPECT_EQ(image.at(1, 3, "albedo.R"), 0.0f);
    EXPECT_FLOAT_EQ(image.at(2, 3, "variance.R"), 1.0f);
    EXPECT_FLOAT_EQ(image.at(2, 3, "variance.G"), 4.0f);
    EXPECT_EQ(image.at(2, 3, "variance.B"), 0.0f);
    for (const char* layer : {"albedo.R", "normal.X", "variance.R"})
        EXPECT_EQ(image.types.at(layer), "float");
}

TEST_F(WriteExr, HeaderSaysHowItWasMade) {
    film_.add(1, 3, FilmSample{Rgb(std::nanf("")), 0});
    ExrSettings settings;
    settings.chromaticities = chromaticitiesFromName("ACEScg");
    const auto attributes = write(settings).attributes;
    EXPECT_EQ(attributes.at("woodcock/version"), version());
    EXPECT_EQ(attributes.at("woodcock/samples"), "64");
    EXPECT_EQ(attributes.at("woodcock/sampleRange"), "16:80");
    EXPECT_EQ(attributes.at("woodcock/seed"), "18364758544493064720");
    EXPECT_EQ(attributes.at("woodcock/sceneDigest"), "digest");
    EXPECT_EQ(attributes.at("woodcock/renderSeconds"), "12.5");
    EXPECT_EQ(attributes.at("woodcock/nonFinite"), "1");
    EXPECT_EQ(attributes.at("woodcock/commandLine"), "woodcock render a");
    EXPECT_EQ(attributes.at("compression"), "zip");
    EXPECT_FALSE(attributes.contains("woodcock/adaptive"));
    EXPECT_EQ(attributes.at("chromaticities"),
              "0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767");
}

/// The range is then a mean, which no pixel need have.
TEST_F(WriteExr, HeaderTellsAdaptiveSamples) {
    metadata_.firstSample = 0, metadata_.endSample = 1, metadata_.adaptive = true;
    const auto attributes = write({}).attributes;
    EXPECT_EQ(attributes.at("woodcock/adaptive"), "1");
    EXPECT_EQ(attributes.at("woodcock/samples"), "1");
    EXPECT_EQ(attributes.at("woodcock/samplesAtMost"), "2");
}

TEST_F(WriteExr, PartsOfTheirOwnHaveTheLayersNameAndPlainChannels) {
    ExrSettings settings;
    settings.layers = layersFromNames({"depth", "emission:half", "samples"});
    settings.chromaticities = chromaticitiesFromName("ACEScg");
    settings.multipart = true;
    const ReadBack rgba = write(settings);
    EXPECT_EQ(rgba.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
    EXPECT_EQ(rgba.attributes.at("oiio:subimagename"), "rgba");
    EXPECT_EQ(rgba.attributes.at("woodcock/sceneDigest"), "digest");
    EXPECT_EQ(rgba.at(2, 3, "G"), film_.radiance(2, 3)[1]);
    struct Part {
        const char* name;
        std::vector<std::string> channels;
        const char* type;
    };
    int number = 1;
    for (const Part& part :
         {Part{"depth", {"Z"}, "float"}, Part{"emission", {"R", "G", "B"}, "half"},
          Part{"samples", {"samples"}, "float"}}) {
        const ReadBack read = readBack(dir_ / "a.exr", number++);
        EXPECT_EQ(read.attributes.at("oiio:subimagename"), part.name);
        EXPECT_EQ(read.channels, part.channels);
        EXPECT_EQ(read.types.at(part.channels[0]), part.type);
        EXPECT_EQ(read.attributes.at("chromaticities"), rgba.attributes.at("chromaticities"));
        EXPECT_EQ(read.x, 1);
        EXPECT_EQ(read.fullWidth, 6);
    }
    EXPECT_EQ(readBack(dir_ / "a.exr", 3).at(1, 2, "samples"), 2.0f);
    EXPECT_THROW(readBack(dir_ / "a.exr", 4), std::out_of_range);
}

TEST_F(WriteExr, HeaderSaysWhatIsKnownOfTheShot) {
    ExrSettings settings;
    settings.interopId = "lin_ap1_scene";
    auto attributes = write(settings).attributes;
    EXPECT_EQ(attributes.at("colorInteropID"), "lin_ap1_scene");
    for (const char* name : {"worldToCamera", "worldToNDC", "framesPerSecond", "ExposureTime"})
        EXPECT_FALSE(attributes.contains(name)) << name;
    metadata_.worldToCamera = Matrix44{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 2, 3, 4, 1};
    metadata_.worldToNdc = metadata_.worldToCamera;
    metadata_.framesPerSecond = Rational{24000, 1001};
    metadata_.shutter = 0.5;
    attributes = write(settings).attributes;
    EXPECT_EQ(attributes.at("worldToCamera"), "1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 2, 3, 4, 1");
    EXPECT_EQ(attributes.at("framesPerSecond"), "24000/1001");
    EXPECT_NEAR(std::stof(attributes.at("ExposureTime")), 0.5 * 1001 / 24000, 1e-7);
    EXPECT_EQ(attributes.at("shutterAngle"), "180");
}

TEST(Chromaticities, KnowTheNamesThatConfigsUse) {
    const auto red = [](const char* name) { return chromaticitiesFromName(name).value()[0]; };
    for (const char* name :
         {"Linear Rec.709 (sRGB)", "lin_rec709", "Utility - Linear - Rec.709", "Linear Rec.709"})
        EXPECT_EQ(red(name), 0.64f) << name;
    for (const char* name : {"ACEScg", "ACES - ACEScg", "lin_ap1"})
        EXPECT_EQ(red(name), 0.713f) << name;
    for (const char* name : {"ACES2065-1", "ACES - ACES2065-1", "lin_ap0"})
        EXPECT_EQ(red(name), 0.7347f) << name;
    EXPECT_EQ(red("Linear Rec.2020"), 0.708f);
    EXPECT_FALSE(chromaticitiesFromName("Linear FilmLight E-Gamut"));
}

}  // namespace
}  // namespace woodcock::test
