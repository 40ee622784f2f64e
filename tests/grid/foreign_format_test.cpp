// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/foreign_format.h"

#include <gtest/gtest.h>

#include "tests/support/expect_error.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/grid/vdb/file.h"

namespace woodcock::test {

using namespace grid;
namespace {

using namespace std::string_literals;

std::string at(std::size_t place, const std::string& mark) {
    std::string bytes(600, '\0');
    return bytes.replace(place, mark.size(), mark);
}

TEST(ForeignFormat, BytesTellItWhateverTheNameSays) {
    const std::pair<std::string, const char*> samples[]{
        {at(128, "DICM"), "a DICOM file"},
        {at(344, "n+1\0"s), "a NIfTI image"},
        {at(344, "ni1\0"s), "a NIfTI image"},
        {at(4, "n+2\0\r\n\x1a\n"s), "a NIfTI image"},
        {"# vtk DataFile Version 3.0\n", "a VTK file"},
        {"<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\">", "a VTK file"},
        {"LASF" + at(0, ""), "a LAS or LAZ point cloud"},
        {"ASTM-E57" + at(0, ""), "an E57 point cloud"},
        {"\x89HDF\r\n\x1a\n", "an HDF5 file"},
        {"Kaydara FBX Binary  \0\x1a"s, "an FBX scene"},
        {"Ogawa\xff", "an Alembic scene"},
        {"PXR-USDC", "a USD file"},
        {"#usda 1.0\n", "a USD file"}};
    for (const auto& [bytes, what] : samples)
        for (const char* name : {"a.raw", "a.obj", "a", "a.csv"}) {
            const auto foreign = foreignFormat(bytes, name);
            ASSERT_TRUE(foreign) << what;
            EXPECT_EQ(foreign->what, what);
            EXPECT_TRUE(foreign->knownByContent && !foreign->readByConvert) << what;
            EXPECT_FALSE(foreign->way.empty());
        }
    EXPECT_FALSE(foreignFormat(at(127, "DICM"), "a"));
    EXPECT_FALSE(foreignFormat(std::string(16, '\0'), "a.vdb"));
    EXPECT_FALSE(foreignFormat(""s, "a.vdb"));
}

TEST(ForeignFormat, NamesTellItWhereBytesDoNot) {
    EXPECT_EQ(foreignFormat("words"s, "Scan.DCM")->what, "a DICOM file");
    EXPECT_EQ(foreignFormat("\x1f\x8b\x08zipped"s, "brain.nii.gz")->what, "a NIfTI image");
    EXPECT_EQ(foreignFormat("\x1f\x8b\x08zipped"s, "smoke.vdb.gz")->what, "a gzip archive");
    EXPECT_EQ(foreignFormat("\x89HDF\r\n\x1a\n"s, "scene.abc")->what, "an Alembic scene");
    EXPECT_EQ(foreignFormat("PK\x03\x04"s, "scene.usdz")->what, "a USD file");
    EXPECT_TRUE(foreignFormat("v 0 0 0"s, "a.obj")->readByConvert);
}

TEST(ForeignFormat, FilesThatAreMissingOrNoneGoByName) {
    const TempDir dir;
    EXPECT_EQ(foreignFormat(dir / "none.laz")->what, "a LAS or LAZ point cloud");
    EXPECT_FALSE(foreignFormat(dir.path()));
    writeText(dir / "smoke.vdb", at(128, "DICM"));
    EXPECT_EQ(foreignFormat(dir / "smoke.vdb")->what, "a DICOM file");
    expectError(ErrorKind::Input, "is not a VDB file but a DICOM file; load the whole series",
                [&] { listGrids(dir / "smoke.vdb"); });
}

}  // namespace
}  // namespace woodcock::test
