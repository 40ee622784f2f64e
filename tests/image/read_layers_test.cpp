// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/read_layers.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/environment_variable.h"
#include "tests/support/expect_error.h"
#include "tests/support/write_image.h"
#include "woodcock/base/temp_dir.h"

namespace woodcock::test {

using namespace image;
namespace {

std::vector<std::string> names(const LayeredImage& image) {
    std::vector<std::string> all;
    for (const ImagePlane& plane : image.planes) all.push_back(plane.name());
    return all;
}

/// sRGB's curve from encoded to light, IEC 61966-2-1.
double light(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

class ReadLayers : public testing::Test {
protected:
    const TempDir dir;
};

TEST_F(ReadLayers, EveryChannelWithItsLayer) {
    ImageFile file;
    file.channels = {"R", "G", "B", "A", "Z", "error.R", "ViewLayer.Combined.R"};
    file.attributes = {{"woodcock/samples", 64}, {"woodcock/seed", std::string("12")}};
    const LayeredImage image = readLayers(writeImage(dir / "a.exr", file));
    EXPECT_EQ(image.width, 16);
    EXPECT_EQ(image.height, 12);
    EXPECT_EQ(image.window, (Film::Window{0, 0, 16, 12}));
    EXPECT_EQ(image.planes.size(), 7u);
    EXPECT_EQ(image.find("error.R")->layer, "error");
    EXPECT_EQ(image.find("ViewLayer.Combined.R")->layer, "ViewLayer.Combined");
    EXPECT_EQ(image.find("ViewLayer.Combined.R")->channel, "R");
    EXPECT_EQ(image.find("none"), nullptr);
    EXPECT_FLOAT_EQ(image.find("Z")->values[16 * 3 + 2], 0.1f + 0.02f + 0.06f + 0.4f);
    EXPECT_EQ(image.number("woodcock/samples"), 64);
    EXPECT_EQ(image.facts.at("woodcock/seed"), "12");
    EXPECT_EQ(image.number("Software"), std::nullopt);
    EXPECT_GT(image.resolution, 0);
    EXPECT_LT(image.resolution, 1e-4);
}

TEST_F(ReadLayers, DataWindow) {
    ImageFile file;
    file.window = {3, 2, 9, 7};
    const LayeredImage image = readLayers(writeImage(dir / "a.exr", file));
    EXPECT_EQ(image.width, 16);
    EXPECT_EQ(image.height, 12);
    EXPECT_EQ(image.window, file.window);
    EXPECT_FLOAT_EQ(image.find("R")->values[0], 0.1f + 0.03f + 0.04f);
}

TEST_F(ReadLayers, NotANumberStays) {
    ImageFile file;
    file.value = [](int x, int, std::size_t) {
        return x == 1 ? std::nan("") : x == 2 ? -std::numeric_limits<double>::infinity() : -0.5;
    };
    const LayeredImage image = readLayers(writeImage(dir / "a.exr", file));
    const std::vector<float>& red = image.find("R")->values;
    EXPECT_EQ(red[0], -0.5f);
    EXPECT_TRUE(std::isnan(red[1]));
    EXPECT_TRUE(std::isinf(red[2]));
}

TEST_F(ReadLayers, HalfResolvesLess) {
    ImageFile file;
    file.type = PixelType::Half;
    EXPECT_DOUBLE_EQ(readLayers(writeImage(dir / "a.exr", file)).resolution, 0x1p-11);
}

TEST_F(ReadLayers, IntegersBesideFloatsMakeNoPicture) {
    const EnvironmentVariable none("OCIO", {});
    const std::string path = (dir / "ids.exr").string();
    const auto output = OIIO::ImageOutput::create(path);
    OIIO::ImageSpec spec(2, 2, 4, OIIO::TypeDesc::FLOAT);
    spec.channelnames = {"R", "G", "B", "id"};
    spec.channelformats = {OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::FLOAT,
                           OIIO::TypeDesc::UINT32};
    ASSERT_TRUE(output->open(path, spec));
    const std::vector<float> pixels(16, 0.25f);
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()));
    ASSERT_TRUE(output->close());
    LayeredImage image = readLayers(path);
    makeSceneLinear(image, "", ColorConfig());
    EXPECT_EQ(image.find("R")->values[0], 0.25f);
    EXPECT_TRUE(image.find("R")->roundings.empty());
    EXPECT_FALSE(image.find("id")->roundings.empty());
}

TEST_F(ReadLayers, PartsOfOneFile) {
    const std::string path = (dir / "parts.exr").string();
    const auto output = OIIO::ImageOutput::create(path);
    std::vector<OIIO::ImageSpec> specs(2, OIIO::ImageSpec(4, 3, 1, OIIO::TypeDesc::FLOAT));
    specs[0].channelnames = {"R"}, specs[1].channelnames = {"Z"};
    specs[0].attribute("oiio:subimagename", "beauty");
    specs[1].attribute("oiio:subimagename", "depth");
    ASSERT_TRUE(output->open(path, 2, specs.data()));
    const std::vector<float> first(12, 1.0f), second(12, 2.0f);
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, first.data()));
    ASSERT_TRUE(output->open(path, specs[1], OIIO::ImageOutput::AppendSubimage));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, second.data()));
    ASSERT_TRUE(output->close());
    const LayeredImage image = readLayers(path);
    ASSERT_NE(image.find("depth.Z"), nullptr);
    EXPECT_EQ(image.find("depth.Z")->values, second);
}

TEST_F(ReadLayers, PicturesBecomeLight) {
    const EnvironmentVariable none("OCIO", {});
    ImageFile file;
    file.format = "png", file.type = PixelType::UInt8;
    file.value = [](int x, int, std::size_t c) {
        return (x * 15.0 + static_cast<double>(c)) / 255;
    };
    LayeredImage image = readLayers(writeImage(dir / "a.png", file));
    EXPECT_EQ(image.resolution, 0);
    makeSceneLinear(image, "", ColorConfig());
    for (int x = 0; x < 16; ++x)
        EXPECT_NEAR(image.find("G")->values[static_cast<std::size_t>(x)],
                    light((x * 15.0 + 1) / 255), 1e-5)
            << x;
}

TEST_F(ReadLayers, GreyPicturesToo) {
    const EnvironmentVariable none("OCIO", {});
    ImageFile file;
    file.format = "png", file.type = PixelType::UInt8, file.channels = {"Y"};
    file.value = [](int x, int, std::size_t) { return x * 17.0 / 255; };
    LayeredImage image = readLayers(writeImage(dir / "a.png", file));
    EXPECT_EQ(names(image), (std::vector<std::string>{"Y"}));
    makeSceneLinear(image, "", ColorConfig());
    for (int x = 0; x < 16; ++x)
        EXPECT_NEAR(image.find("Y")->values[static_cast<std::size_t>(x)], light(x * 17.0 / 255),
                    1e-5)
            << x;
}

// PNG's alpha is straight: what is half transparent carries half of the light, not half of the
// code.
TEST_F(ReadLayers, StraightAlphaMultipliesLight) {
    const EnvironmentVariable none("OCIO", {});
    // The encoder divides by alpha what it is given, as OpenImageIO's colours are multiplied.
    const std::string path = (dir / "a.png").string();
    const auto output = OIIO::ImageOutput::create(path);
    OIIO::ImageSpec spec(1, 1, 4, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    const unsigned char pixel[4] = {200, 100, 50, 128};
    ASSERT_TRUE(output->open(path, spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, pixel));
    ASSERT_TRUE(output->close());
    LayeredImage image = readLayers(path);
    makeSceneLinear(image, "", ColorConfig());
    EXPECT_NEAR(image.find("R")->values[0], light(200 / 255.0) * 128 / 255, 1e-5);
    EXPECT_NEAR(image.find("B")->values[0], light(50 / 255.0) * 128 / 255, 1e-5);
}

TEST_F(ReadLayers, ColourSpacesAreTheConfigs) {
    const EnvironmentVariable none("OCIO", {});
    ImageFile file;
    file.value = [](int, int, std::size_t) { return 0.25; };
    file.channels = {"R", "G", "B", "Z"};
    writeImage(dir / "a.exr", file);
    LayeredImage image = readLayers(dir / "a.exr");
    makeSceneLinear(image, "", ColorConfig());
    EXPECT_EQ(image.find("R")->values[0], 0.25f);  // floats are light
    makeSceneLinear(image, "srgb_tx", ColorConfig());
    EXPECT_NEAR(image.find("R")->values[0], light(0.25), 1e-5);
    EXPECT_EQ(image.find("Z")->values[0], 0.25f);  // no colour
    expectError(ErrorKind::Input, "colour space 'sRGBB' not found in the OpenColorIO config",
                [&] { makeSceneLinear(image, "sRGBB", ColorConfig()); });
}

TEST_F(ReadLayers, WhatCannotBeRead) {
    expectError(ErrorKind::Input, "there is no such file", [&] { readLayers(dir / "none.exr"); });
    expectError(ErrorKind::Input, "it is a directory", [&] { readLayers(dir.path()); });
    writeText(dir / "text.exr", "no image");
    expectError(ErrorKind::Input, "text.exr", [&] { readLayers(dir / "text.exr"); });
    writeImage(dir / "a.exr", {});
    const std::string whole = readText(dir / "a.exr");
    for (std::size_t size = 0; size < whole.size(); size += 37) {
        writeText(dir / "cut.exr", whole.substr(0, size));
        expectError(ErrorKind::Input, "cut.exr", [&] { readLayers(dir / "cut.exr"); });
    }
}

}  // namespace
}  // namespace woodcock::test
