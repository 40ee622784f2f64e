// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/read_texture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/environment_variable.h"
#include "tests/support/expect_error.h"
#include "tests/support/paths.h"
#include "woodcock/proof/support/read_back.h"

namespace woodcock::test {

using namespace image;
using namespace proof;

namespace {

/// IEC 61966-2-1, backwards.
double linear(double shown) {
    return shown <= 0.04045 ? shown / 12.92 : std::pow((shown + 0.055) / 1.055, 2.4);
}

class ReadTexture : public testing::Test {
    const EnvironmentVariable none_{"OCIO", std::nullopt};

protected:
    Rgb read(const std::string& file, const std::string& space) const {
        return readTexture(dir_ / file, space, config_).at(0, 0);
    }
    std::string refusal(const std::string& file, const std::string& space) const {
        return messageOf(ErrorKind::Input, [&] { read(file, space); });
    }

    const ColorConfig config_;
    TempDir dir_;
};

TEST_F(ReadTexture, TakesIntegersForPicturesAndFloatsForLight) {
    const float half = 128 / 255.0f;
    proof::writeFloats(dir_ / "a.png", 1, 1, 3, {half, 1, 0});
    const Rgb picture = read("a.png", "");
    EXPECT_NEAR(picture[0], linear(double{half}), 2e-5);
    EXPECT_NEAR(picture[1], 1, 2e-5);
    EXPECT_NEAR(picture[2], 0, 2e-5);
    proof::writeFloats(dir_ / "a.exr", 1, 1, 3, {0.5f, 7, 0});
    EXPECT_EQ(read("a.exr", ""), Rgb(0.5f, 7, 0));
    EXPECT_NEAR(read("a.exr", "sRGB texture")[0], linear(0.5), 2e-5);
}

TEST_F(ReadTexture, LeavesNumbersThatAreNoColours) {
    proof::writeFloats(dir_ / "a.png", 1, 1, 1, {0.2f});
    for (const char* space : {"linear", "raw", "data", "Raw"})
        EXPECT_NEAR(read("a.png", space)[2], 0.2f, 1e-7) << space;
}

TEST_F(ReadTexture, TurnsPrimariesAndKeepsWithinTheGamut) {
    // ACEScg's green in Rec.709, with the white of D60 adapted to D65 (Bradford): its red is
    // negative.
    proof::writeFloats(dir_ / "a.exr", 1, 1, 3, {0, 1, 0});
    const Rgb green = read("a.exr", "ACEScg");
    EXPECT_EQ(green[0], 0);
    EXPECT_NEAR(green[1], 1.1408, 1e-3);
    EXPECT_EQ(green[2], 0);
    proof::writeFloats(dir_ / "b.exr", 1, 1, 3, {0.5f, 0.5f, 0.5f});
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(read("b.exr", "acescg")[c], 0.5, 1e-4);
}

TEST_F(ReadTexture, NamesWhatItDoesNotKnow) {
    proof::writeFloats(dir_ / "a.png", 1, 1, 3, {0, 1, 0});
    const std::string message = refusal("a.png", "sRGB - Textur");
    for (const char* part : {"a.png", "'sRGB - Textur' not found", "it has: ", "sRGB texture"})
        EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_NE(refusal("b.png", "").find("there is no such file"), std::string::npos);
}

TEST_F(ReadTexture, AsksForTheSpaceWhereTheConfigHasNone) {
    writeText(dir_ / "config.ocio",
              "ocio_profile_version: 2\n"
              "roles: {default: plain, scene_linear: plain}\n"
              "file_rules: [!<Rule> {name: Default, colorspace: default}]\n"
              "displays:\n"
              "  screen:\n"
              "    - !<View> {name: as it is, colorspace: plain}\n"
              "colorspaces:\n"
              "  - !<ColorSpace> {name: plain}\n");
    const ColorConfig config(dir_ / "config.ocio");
    proof::writeFloats(dir_ / "a.png", 1, 1, 3, {0, 1, 0});
    expectError(ErrorKind::Input, "name the texture's colour space",
                [&] { readTexture(dir_ / "a.png", "", config); });
    EXPECT_EQ(readTexture(dir_ / "a.png", "plain", config).at(0, 0), Rgb(0, 1, 0));
}

}  // namespace
}  // namespace woodcock::test
