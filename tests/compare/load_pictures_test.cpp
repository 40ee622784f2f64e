// SPDX-License-Identifier: Apache-2.0
#include "woodcock/compare/load_pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/expect_error.h"
#include "tests/support/write_image.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/compare/comparison.h"

namespace woodcock::test {

using namespace compare;
using namespace image;
namespace {

class LoadPictures : public testing::Test {
protected:
    std::filesystem::path write(const std::string& name, const ImageFile& file) const {
        return writeImage(dir / name, file);
    }
    static LoadedPictures load(const std::vector<PictureSource>& sources, bool resample = false) {
        return loadPictures(sources, resample, ColorConfig());
    }
    static ImageFile constant(double value) {
        ImageFile file;
        file.value = [value](int, int, std::size_t) { return value; };
        return file;
    }

    const TempDir dir;
};

TEST_F(LoadPictures, LettersFactsAndErrorLayers) {
    ImageFile file;
    file.channels = {"R", "G", "B", "A", "samples", "error.R", "error.G", "error.B"};
    file.attributes = {{"woodcock/samples", 64},
                       {"woodcock/renderSeconds", 2.5f},
                       {"Software", std::string("woodcock 1")}};
    const auto a = write("a.exr", file);
    const LoadedPictures loaded = load({{a, {}, {}}, {a, {}, {}}});
    ASSERT_EQ(loaded.pictures.size(), 2u);
    const Picture& p = loaded.pictures[1];
    EXPECT_EQ(p.letter, "B");
    EXPECT_EQ(p.samples, 64);
    EXPECT_EQ(p.seconds, 2.5);
    EXPECT_EQ(p.madeBy, "woodcock 1");
    EXPECT_EQ(p.errorsFrom, "error layer");
    ASSERT_EQ(p.planes.size(), 4u);  // neither samples nor errors
    EXPECT_FLOAT_EQ(p.find("G")->errors[0], 0.1f + 0.6f);
    EXPECT_TRUE(p.find("A")->errors.empty());
}

TEST_F(LoadPictures, UnknownErrorsAreNone) {
    ImageFile file;
    file.channels = {"R", "error.R"};
    file.value = [](int, int, std::size_t c) {
        return c ? std::numeric_limits<double>::infinity() : 1.0;
    };
    const auto a = write("a.exr", file);
    EXPECT_TRUE(load({{a, {}, {}}, {a, {}, {}}}).pictures[0].planes[0].errors.empty());
}

TEST_F(LoadPictures, DepthOfNothingIsNone) {
    ImageFile file;
    file.channels = {"R", "Z"};
    file.value = [](int x, int, std::size_t) { return x == 0 ? 1e10 : 5.0; };
    const auto a = write("a.exr", file);
    const Picture p = load({{a, {}, {}}, {a, {}, {}}}).pictures[0];
    EXPECT_TRUE(std::isnan(p.planes[1].values[0]));
    EXPECT_EQ(p.planes[1].values[1], 5);
    EXPECT_EQ(p.planes[0].values[0], 1e10f);
}

TEST_F(LoadPictures, SeedsGiveMeanAndError) {
    const auto a = write("a.exr", constant(1)), b = write("b.exr", constant(2)),
               c = write("c.exr", constant(6));
    const Picture p = load({{a, {b, c}, {}}, {a, {}, {}}}).pictures[0];
    EXPECT_EQ(p.files.size(), 3u);
    EXPECT_FLOAT_EQ(p.planes[0].values[0], 3);
    // Standard deviation sqrt((4 + 1 + 9) / 2), over sqrt(3).
    EXPECT_FLOAT_EQ(p.planes[0].errors[0], static_cast<float>(std::sqrt(7.0 / 3)));
    EXPECT_EQ(p.errorDegrees, 2);
}

TEST_F(LoadPictures, SeedsOfOneSizeAndChannels) {
    const auto a = write("a.exr", {});
    ImageFile other;
    other.width = 8;
    const auto small = write("small.exr", other);
    expectError(ErrorKind::Input, "is not another seed of", [&] {
        load({{a, {small}, {}}, {a, {}, {}}});
    });
    ImageFile grey;
    grey.channels = {"R"};
    const auto red = write("red.exr", grey);
    expectError(ErrorKind::Input, "its channels are R, not", [&] {
        load({{a, {red}, {}}, {a, {}, {}}});
    });
}

TEST_F(LoadPictures, EqualSeedsAreNoted) {
    ImageFile file;
    file.attributes = {{"woodcock/seed", std::string("4")},
                       {"woodcock/sampleRange", std::string("0:8")}};
    const auto a = write("a.exr", file);
    ASSERT_EQ(load({{a, {}, {}}, {a, {}, {}}}).notes.size(), 1u);
    EXPECT_NE(load({{a, {}, {}}, {a, {}, {}}}).notes[0].find("same seed, 4"), std::string::npos);
    EXPECT_NE(
        load({{a, {a}, {}}, {a, {}, {}}}).notes[0].find("their differences do not show the error"),
        std::string::npos);
}

TEST_F(LoadPictures, DataWindowsAreLaidOverEachOther) {
    ImageFile one, two;
    one.window = {0, 0, 10, 9};
    two.window = {4, 3, 16, 12};
    const LoadedPictures loaded =
        load({{write("a.exr", one), {}, {}}, {write("b.exr", two), {}, {}}});
    for (const Picture& p : loaded.pictures) {
        EXPECT_EQ(p.x0, 4);
        EXPECT_EQ(p.y0, 3);
        EXPECT_EQ(p.width, 6);
        EXPECT_EQ(p.height, 6);
        ASSERT_EQ(p.planes[0].values.size(), 36u);
        EXPECT_FLOAT_EQ(p.planes[0].values[7], 0.1f + 0.05f + 0.08f);  // at 5, 4
    }
    ASSERT_EQ(loaded.notes.size(), 1u);
    EXPECT_NE(loaded.notes[0].find("[4, 10) x [3, 9)"), std::string::npos) << loaded.notes[0];
    two.window = {12, 3, 16, 12};
    expectError(ErrorKind::Input, "no pixel in common", [&] {
        load({{dir / "a.exr", {}, {}}, {write("b.exr", two), {}, {}}});
    });
}

TEST_F(LoadPictures, OnlyCommonChannels) {
    ImageFile one, two;
    one.channels = {"R", "G", "B", "Z"};
    two.channels = {"B", "G", "R", "transmittance.R"};
    const auto a = write("a.exr", one), b = write("b.exr", two);
    const LoadedPictures loaded = load({{a, {}, {}}, {b, {}, {}}});
    for (std::size_t i = 0; i < 2; ++i) {
        std::vector<std::string> names;
        for (const ComparedPlane& plane : loaded.pictures[i].planes) names.push_back(plane.name);
        EXPECT_EQ(names.size(), 3u);
        EXPECT_EQ(loaded.pictures[0].planes[i].name, loaded.pictures[1].planes[i].name);
    }
    EXPECT_NE(loaded.notes[0].find("Z, transmittance.R"), std::string::npos) << loaded.notes[0];
    one.channels = {"Z"};
    expectError(ErrorKind::Input, "the images have no channel in common: '", [&] {
        load({{write("z.exr", one), {}, {}}, {b, {}, {}}});
    });
}

TEST_F(LoadPictures, BlendersCombinedPassIsThePicture) {
    ImageFile blender;
    blender.channels = {"ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B",
                        "ViewLayer.Depth.Z"};
    const LoadedPictures loaded =
        load({{write("a.exr", {}), {}, {}}, {write("b.exr", blender), {}, {}}});
    EXPECT_EQ(loaded.pictures[1].planes.size(), 3u);
}

TEST_F(LoadPictures, OtherSizesAreRefusedOrAveraged) {
    ImageFile large;
    large.width = 32, large.height = 36;
    large.channels = {"R", "error.R"};
    large.value = [](int x, int y, std::size_t c) { return c ? 0.6 : x + 100.0 * y; };
    ImageFile small = large;
    small.width = 16, small.height = 12;
    const auto a = write("a.exr", large), b = write("b.exr", small);
    expectError(ErrorKind::Input, "is 32 x 36 pixels and '", [&] {
        load({{a, {}, {}}, {b, {}, {}}});
    });
    const LoadedPictures loaded = load({{a, {}, {}}, {b, {}, {}}}, true);
    const Picture& p = loaded.pictures[0];
    EXPECT_EQ(p.width, 16);
    EXPECT_EQ(p.height, 12);
    // Pixel 2, 1: the mean of columns 4, 5 and rows 3, 4, 5.
    EXPECT_FLOAT_EQ(p.planes[0].values[16 + 2], 4.5f + 400);
    EXPECT_FLOAT_EQ(p.planes[0].errors[16 + 2], static_cast<float>(0.6 / std::sqrt(6.0)));
    EXPECT_DOUBLE_EQ(p.sharedNoise, 1);
    EXPECT_NE(loaded.notes[0].find("A: averaged over areas from 32 x 36 to 16 x 12"),
              std::string::npos)
        << loaded.notes[0];
    large.window = {0, 0, 8, 8};
    expectError(ErrorKind::Input, "only a part of its image", [&] {
        load({{write("crop.exr", large), {}, {}}, {b, {}, {}}}, true);
    });
}

// What a byte cannot hold is no difference; a whole step more is one.
TEST_F(LoadPictures, BytesKnowTheirRounding) {
    const auto light = write("a.exr", constant(0.5));
    ImageFile picture = constant(188.0 / 255);  // the nearest code of 0.5 is 188, 0.5029
    picture.format = "png", picture.type = PixelType::UInt8;
    const auto near = write("near.png", picture);
    picture.value = [](int, int, std::size_t) { return 189.0 / 255; };
    const auto next = write("next.png", picture);
    const Comparison c =
        compare::compare(load({{light, {}, {}}, {near, {}, {}}, {next, {}, {}}}), {});
    // The slope of sRGB's curve at 188, times half a code.
    EXPECT_NEAR(c.pictures[1].planes[0].roundings[0],
                2.4 / 1.055 * std::pow((188.0 / 255 + 0.055) / 1.055, 1.4) * 0.5 / 255, 1e-5);
    EXPECT_FALSE(c.images[0].differ) << c.images[0].reason;
    EXPECT_TRUE(c.images[1].differ);
}

TEST_F(LoadPictures, TwoAtLeast) {
    const auto a = write("a.exr", {});
    expectError(ErrorKind::Usage, "compare takes 2 to 26 images, not 1", [&] {
        load({{a, {}, {}}});
    });
}

}  // namespace
}  // namespace woodcock::test
