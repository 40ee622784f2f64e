// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/outputs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/environment_variable.h"
#include "tests/support/expect_error.h"
#include "tests/support/paths.h"
#include "woodcock/base/error.h"
#include "woodcock/proof/support/read_back.h"

namespace woodcock::test {

using namespace image;
using namespace proof;

namespace {

/// One grey that a Standard sRGB view shows as byte 118 (0.18), one half as bright behind half the
/// alpha, one black.
class OutputsTest : public testing::Test {
protected:
    OutputsTest() : film_(5, 3, {1, 1, 4, 2}) {
        film_.add(1, 1, FilmSample{Rgb(0.18f), 1});
        film_.add(2, 1, FilmSample{Rgb(0.09f), 0.5f});
        settings_.display = {"sRGB", "Standard", "", 0};
    }

    proof::ReadBack write(const char* name) {
        settings_.files = {dir_ / name};
        Outputs(settings_).write(film_, {});
        return proof::readBack(dir_ / name);
    }

    std::string refusal(std::vector<std::filesystem::path> files) {
        settings_.files = std::move(files);
        return messageOf(ErrorKind::Usage, [&] { Outputs outputs(settings_); });
    }

    const EnvironmentVariable none_{"OCIO", std::nullopt};
    const TempDir dir_;
    Film film_;
    OutputSettings settings_;
};

TEST_F(OutputsTest, PngIsOpaqueByDefault) {
    const proof::ReadBack image = write("a.png");
    EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B"}));
    EXPECT_EQ(image.width, 3);
    EXPECT_EQ(image.height, 1);
    EXPECT_EQ(image.at(0, 0, "R"), 118.0f);
    EXPECT_EQ(image.at(1, 0, "G"), 85.0f);  // 0.09: 85.03
    EXPECT_EQ(image.at(2, 0, "B"), 0.0f);
}

TEST_F(OutputsTest, PngAlphaIsStraight) {
    settings_.withAlpha = true;
    const proof::ReadBack image = write("a.png");
    EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
    for (const char* channel : {"R", "G", "B"}) {
        EXPECT_EQ(image.at(0, 0, channel), 118.0f);
        EXPECT_EQ(image.at(1, 0, channel), 118.0f);
        EXPECT_EQ(image.at(2, 0, channel), 0.0f);
    }
    EXPECT_EQ(image.at(0, 0, "A"), 255.0f);
    EXPECT_EQ(image.at(1, 0, "A"), 128.0f);
    EXPECT_EQ(image.at(2, 0, "A"), 0.0f);
}

/// What an sRGB display shows of linear light, as a byte.
double srgbByte(double v) {
    return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
}

/// Light without cover, with a quarter as much cover as light, with more, and nothing.
class GlowingOutputs : public OutputsTest {
protected:
    GlowingOutputs() {
        film_ = Film(4, 1, {0, 0, 4, 1});
        film_.add(0, 0, FilmSample{Rgb(1, 0.5f, 0.2f), 0});
        film_.add(1, 0, FilmSample{Rgb(0.4f, 0.2f, 0.1f), 0.1f});
        film_.add(2, 0, FilmSample{Rgb(0.18f), 1});
        settings_.withAlpha = settings_.glows = true;
    }
};

TEST_F(GlowingOutputs, RaiseAlphaToTheLight) {
    const proof::ReadBack image = write("a.png");
    const double colour[2][3]{{1, 0.5, 0.2}, {1, 0.5, 0.25}};  // over alphas of 1 and 0.4
    const char* const names[]{"R", "G", "B"};
    for (int x = 0; x < 2; ++x)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(image.at(x, 0, names[c]), srgbByte(colour[x][c]), 0.5) << x << names[c];
    EXPECT_EQ(image.at(0, 0, "A"), 255.0f);
    EXPECT_EQ(image.at(1, 0, "A"), 102.0f);  // 0.4
    EXPECT_EQ(image.at(2, 0, "A"), 255.0f);
    EXPECT_EQ(image.at(2, 0, "R"), 118.0f);
    for (const char* channel : {"R", "G", "B", "A"}) EXPECT_EQ(image.at(3, 0, channel), 0.0f);
}

TEST_F(GlowingOutputs, CountExposure) {
    settings_.display.exposure = 1;
    const proof::ReadBack image = write("a.png");
    EXPECT_EQ(image.at(1, 0, "A"), 204.0f);                // 0.8
    EXPECT_NEAR(image.at(1, 0, "G"), srgbByte(0.5), 0.5);  // as before: twice the light and cover
    settings_.display.exposure = -1;
    EXPECT_EQ(write("a.png").at(1, 0, "A"), 51.0f);  // 0.2
}

TEST_F(GlowingOutputs, SayWhatIsRaised) {
    settings_.files = {dir_ / "a.exr", dir_ / "a.png"};
    const std::string note = Outputs(settings_).write(film_, {});
    EXPECT_NE(note.find("a.png: 50 % of the pixels emit more light than their alpha covers"),
              std::string::npos)
        << note;
    settings_.withAlpha = false;
    EXPECT_EQ(Outputs(settings_).write(film_, {}), "");
    settings_.withAlpha = true, settings_.glows = false;
    EXPECT_EQ(Outputs(settings_).write(film_, {}), "");
}

TEST_F(GlowingOutputs, LeaveExrAndWhatDoesNotGlowAsTheyAre) {
    const proof::ReadBack exr = write("a.exr");
    EXPECT_EQ(exr.at(0, 0, "A"), 0.0f);
    EXPECT_EQ(exr.at(0, 0, "G"), 0.5f);
    EXPECT_EQ(exr.at(1, 0, "A"), 0.1f);
    settings_.glows = false;
    EXPECT_EQ(write("a.png").at(1, 0, "A"), 26.0f);  // 0.1
}

TEST_F(OutputsTest, TiffHas16BitsAndStraightAlpha) {
    settings_.withAlpha = true;
    const proof::ReadBack image = write("a.TIF");
    EXPECT_EQ(image.types.at("R"), "uint16");
    EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
    // Within what the tables of OpenColorIO interpolate.
    for (int x = 0; x < 2; ++x) EXPECT_NEAR(image.at(x, 0, "R"), srgbByte(0.18) / 255, 5e-4) << x;
    EXPECT_NEAR(image.at(1, 0, "A"), 0.5, 1.0 / 65535);
    settings_.withAlpha = false;
    const proof::ReadBack opaque = write("b.tiff");
    EXPECT_EQ(opaque.channels.size(), 3u);
    EXPECT_NEAR(opaque.at(1, 0, "R"), srgbByte(0.09) / 255, 5e-4);
}

TEST_F(OutputsTest, WebPIsOnBlack) {
    settings_.withAlpha = true;
    const proof::ReadBack image = write("a.webp");
    EXPECT_EQ(image.channels.size(), 3u);
    EXPECT_NEAR(image.at(0, 0, "R"), 118, 4);
    EXPECT_NEAR(image.at(1, 0, "R"), 85, 4);
    EXPECT_NEAR(image.at(2, 0, "R"), 0, 4);
}

TEST_F(OutputsTest, JpegIsOnBlack) {
    settings_.withAlpha = true;
    const proof::ReadBack image = write("a.JPG");
    EXPECT_EQ(image.channels.size(), 3u);
    EXPECT_NEAR(image.at(0, 0, "R"), 118, 2);
    EXPECT_NEAR(image.at(1, 0, "R"), 85, 2);
    EXPECT_NEAR(image.at(2, 0, "R"), 0, 2);
}

TEST_F(OutputsTest, ExposureBrightensPicturesAndLeavesExrAlone) {
    settings_.display.exposure = 1;
    EXPECT_EQ(write("a.png").at(1, 0, "R"), 118.0f);
    EXPECT_EQ(write("a.exr").at(2, 1, "R"), 0.09f);
}

TEST_F(OutputsTest, ExrHasTheWorkingSpacesChromaticities) {
    EXPECT_EQ(write("a.exr").attributes.at("chromaticities"),
              "0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329");
}

TEST_F(OutputsTest, SeveralFilesInOneRun) {
    settings_.files = {dir_ / "a.exr", dir_ / "a.png", dir_ / "b.jpeg"};
    Outputs(settings_).write(film_, {});
    for (const auto& file : settings_.files) EXPECT_TRUE(exists(file)) << file;
}

TEST_F(OutputsTest, OneThatFailsLetsTheOthersBeWritten) {
    create_directory(dir_ / "sub");
    settings_.files = {dir_ / "sub/a.exr", dir_ / "a.png"};
    const Outputs outputs(settings_);
    remove(dir_ / "sub");
    const std::string message = messageOf(ErrorKind::Failure, [&] { outputs.write(film_, {}); });
    EXPECT_EQ(message,
              "cannot write '" + (dir_ / "sub/a.exr").string() + "': No such file or directory");
    EXPECT_TRUE(exists(dir_ / "a.png"));
}

TEST_F(OutputsTest, WhatCannotWorkIsRefusedBeforehand) {
    EXPECT_EQ(refusal({"a.tga"}),
              "cannot write 'a.tga': unknown image extension '.tga'; known: "
              ".exr, .png, .jpg, .jpeg, .tif, .tiff, .webp");
    EXPECT_EQ(refusal({"image"}),
              "cannot write 'image': it has no extension to tell the format; "
              "known: .exr, .png, .jpg, .jpeg, .tif, .tiff, .webp");
    EXPECT_EQ(refusal({dir_ / "a.exr", dir_ / "b.exr", dir_ / "a.exr"}),
              "output '" + (dir_ / "a.exr").string() + "' is named twice");
    EXPECT_NE(refusal({dir_ / "none/a.exr"}).find("there is no directory"), std::string::npos);

    settings_.display.view = "Filmic";
    EXPECT_NE(refusal({dir_ / "a.png"}).find("view 'Filmic' not found"), std::string::npos);
    EXPECT_EQ(refusal({dir_ / "a.exr"}), "no error");  // nothing is shown
}

}  // namespace
}  // namespace woodcock::test
