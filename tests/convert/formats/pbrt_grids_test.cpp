// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/expect_error.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/convert/formats/dense_formats.h"

namespace woodcock::test {

using namespace convert;
namespace {

const std::string smoke = R"(
# "float density" [ 9 9 ]
Film "rgb" "integer xresolution" 100
MakeNamedMedium "air" "string type" "homogeneous" "rgb sigma_a" [ 1 1 1 ]
MakeNamedMedium "smoke" "string type" "uniformgrid"
    "integer nx" 2 "integer ny" [ 1 ] "integer nz" 3
    "point3 p0" [ 1 2 3 ] "point3 p1" [ 3 3 9 ]
    "spectrum sigma_a" [ 200 10 900 10 ] "float scale" [ 10 ]
    "float Lescale" 2
    "float density" [ 0 .5 1e-3 3 # a comment
        4 5 ]
AttributeBegin
)";

class PbrtGrids : public testing::Test {
protected:
    std::vector<DenseVolume> read(const std::string& text,
                                  const std::optional<std::string>& medium = {}) const {
        writeText(dir / "a.pbrt", text);
        return readPbrtGrids(dir / "a.pbrt", medium);
    }
    const TempDir dir;
};

TEST_F(PbrtGrids, AreFoundInAScene) {
    const std::vector<DenseVolume> volumes = read(smoke);
    ASSERT_EQ(volumes.size(), 1u);
    const DenseVolume& volume = volumes.front();
    EXPECT_EQ(volume.name, "density");
    EXPECT_EQ(volume.dims, (Dims{2, 1, 3}));
    std::vector<float> values(6);
    readBlock(volume, {0, 0, 0}, {2, 1, 3}, values.data());
    EXPECT_EQ(values, (std::vector<float>{0, 1e-3f, 4, 0.5f, 3, 5}));
    // Samples at (i + 1/2) / n of the box.
    EXPECT_EQ(volume.worldFromIndex.point({0, 0, 0}), (Vec3d{1.5, 2.5, 4}));
    EXPECT_EQ(volume.worldFromIndex.point({1, 0, 2}), (Vec3d{2.5, 2.5, 8}));
    EXPECT_TRUE(volume.notes.empty());
    EXPECT_EQ(read("Translate 1 0 0\n" + smoke).front().notes.size(), 1u);
}

TEST_F(PbrtGrids, OfColoursAndSeveralQuantities) {
    const std::vector<DenseVolume> volumes =
        read(R"(MakeNamedMedium "m" "string type" "rgbgrid" "integer nx" 2
                "rgb sigma_a" [ 1 2 3 4 5 6 ] "rgb sigma_s" [ 7 8 9 10 11 12 ])");
    ASSERT_EQ(volumes.size(), 2u);
    EXPECT_EQ(volumes[1].name, "sigma_s");
    EXPECT_EQ(volumes[1].channels, 3);
    std::vector<float> values(6);
    readBlock(volumes[1], {0, 0, 0}, {2, 1, 1}, values.data());
    EXPECT_EQ(values, (std::vector<float>{7, 8, 9, 10, 11, 12}));
}

TEST_F(PbrtGrids, AreChosenByName) {
    const std::string two = smoke + R"(MakeNamedMedium "other" "string type" "uniformgrid"
                                       "float density" [ 1 ])";
    expectError(ErrorKind::Input, "smoke, other", [&] { read(two); });
    EXPECT_EQ(read(two, "other").front().dims, (Dims{1, 1, 1}));
    expectError(ErrorKind::Input, "did you mean 'smoke'", [&] { read(two, "smoky"); });
}

TEST_F(PbrtGrids, DamagedScenesAreRefused) {
    const std::size_t end = smoke.find("4 5 ]") + 5;
    for (std::size_t n = 0; n < end; ++n)
        expectError(ErrorKind::Input, "a.pbrt", [&] { read(smoke.substr(0, n)); });
    const auto refused = [&](const std::string& parameters, const std::string& said) {
        expectError(ErrorKind::Input, said, [&] {
            read("MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" " + parameters);
        });
    };
    refused(R"("integer nx" 2 "float density" [ 1 2 3 ])", "has 3 numbers; nx x ny x nz = 2");
    refused(R"("integer nx" -2 "float density" [ 1 2 ])", "whole number");
    refused(R"("integer nx" 1e9 "integer ny" 1e9 "integer nz" 1e9 "float density" [ 1 ])",
            "not a volume");
    refused(R"("float density" [ 1 )", "end of the file");
    refused(R"("float density" [ x ])", "'x' where parameter 'density'");
    refused(R"("density" [ 1 ])", "float density");
    refused(R"("float density" [ 1 ] "point3 p1" [ 0 1 1 ])", "empty");
    refused("", "no values");
    expectError(ErrorKind::Input, "includes 'density.pbrt'",
                [&] { read("Include \"density.pbrt\""); });
}

}  // namespace
}  // namespace woodcock::test
