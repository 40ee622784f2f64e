// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/read_image.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/expect_error.h"
#include "tests/support/paths.h"
#include "woodcock/base/error.h"
#include "woodcock/proof/support/read_back.h"

namespace woodcock::test {

using namespace image;
using namespace proof;

namespace {

std::string refusalOf(const std::filesystem::path& file) {
    return messageOf(ErrorKind::Input, [&] { readImage(file); });
}

class ReadImage : public testing::Test {
protected:
    TempDir dir_;
};

TEST_F(ReadImage, KeepsFloatsAndOrder) {
    proof::writeFloats(dir_ / "a.exr", 2, 2, 3, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 1e-6f, 60000.5f});
    const Image image = readImage(dir_ / "a.exr");
    EXPECT_EQ(image.width, 2);
    EXPECT_EQ(image.height, 2);
    EXPECT_EQ(image.at(1, 0), Rgb(3, 4, 5));
    EXPECT_EQ(image.at(1, 1), Rgb(9, 1e-6f, 60000.5f));
}

TEST_F(ReadImage, GreyFillsAllChannels) {
    proof::writeFloats(dir_ / "a.tif", 2, 1, 1, {0.25f, 7});
    const Image image = readImage(dir_ / "a.tif");
    EXPECT_EQ(image.at(0, 0), Rgb(0.25f));
    EXPECT_EQ(image.at(1, 0), Rgb(7.0f));
}

TEST_F(ReadImage, IgnoresAlpha) {
    proof::writeFloats(dir_ / "a.exr", 1, 1, 4, {4, 5, 6, -1});
    EXPECT_EQ(readImage(dir_ / "a.exr").at(0, 0), Rgb(4, 5, 6));
    // OpenImageIO takes colours that are multiplied by alpha; PNG holds them as they were before.
    proof::writeFloats(dir_ / "a.png", 1, 1, 4, {0.2f, 0.1f, 0, 0.2f});
    EXPECT_EQ(readImage(dir_ / "a.png").at(0, 0)[0], 1);
    EXPECT_NEAR(readImage(dir_ / "a.png").at(0, 0)[1], 0.5, 0.01);
}

TEST_F(ReadImage, NamesCountAndPlaceOfWhatIsNoLight) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    proof::writeFloats(dir_ / "a.exr", 3, 2, 3,
                       {0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, -2.5f, 1, nan, 1, inf});
    const std::string message = refusalOf(dir_ / "a.exr");
    EXPECT_NE(message.find("3 negative, NaN or infinite values"), std::string::npos) << message;
    EXPECT_NE(message.find("-2.5 in green at column 1, row 1"), std::string::npos) << message;
}

TEST_F(ReadImage, NamesTheFileThatCannotBeRead) {
    EXPECT_EQ(refusalOf("/nowhere/sky.exr"),
              "cannot read image '/nowhere/sky.exr': there is no such file");
    EXPECT_NE(refusalOf(dir_.path()).find("it is a directory"), std::string::npos);

    writeText(dir_ / "text.exr", "this is no image");
    EXPECT_NE(refusalOf(dir_ / "text.exr").find("text.exr"), std::string::npos);

    proof::writeFloats(dir_ / "whole.exr", 64, 64, 3, std::vector<float>(64 * 64 * 3, 0.3f));
    const std::string bytes = readText(dir_ / "whole.exr");
    writeText(dir_ / "cut.exr", bytes.substr(0, bytes.size() / 2));
    EXPECT_NE(refusalOf(dir_ / "cut.exr").find("cut.exr"), std::string::npos);
}

TEST_F(ReadImage, RefusesSizesBeyondTheFile) {
    writeText(dir_ / "vast.ppm", "P6 2000000 2000000 255\n");
    const std::string message = refusalOf(dir_ / "vast.ppm");
    EXPECT_NE(message.find("its header says 2000000 x 2000000 pixels"), std::string::npos)
        << message;
}

}  // namespace
}  // namespace woodcock::test
