// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <zlib.h>

#include "tests/support/expect_error.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/convert/formats/dense_formats.h"

namespace woodcock::test {

using namespace convert;
namespace {

namespace fs = std::filesystem;

std::string gzip(const std::string& bytes) {
    z_stream stream{};
    deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, 16 + MAX_WBITS, 9, Z_DEFAULT_STRATEGY);
    std::string packed(bytes.size() + 100, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

std::string shorts(int n, bool big = false) {
    std::string bytes;
    for (int i = 0; i < n; ++i) {
        const char low = static_cast<char>(i & 255), high = static_cast<char>(i >> 8);
        bytes += big ? high : low;
        bytes += big ? low : high;
    }
    return bytes;
}

std::string header(const std::string& more) {
    return "NRRD0004\n# a comment\ntype: short\ndimension: 3\nsizes: 2 3 4\nkey:=a value\n" + more +
           "\n";
}

double valueAt(const DenseVolume& volume, const Dims& at) {
    std::vector<double> values(static_cast<std::size_t>(volume.channels));
    readBlock(volume, at, {1, 1, 1}, values.data());
    return values.back();
}

class Nrrd : public testing::Test {
protected:
    DenseVolume read(const std::string& bytes) const {
        writeText(dir / "a.nrrd", bytes);
        return readNrrd(dir / "a.nrrd");
    }
    void expectRefused(const std::string& bytes, const std::string& said) const {
        expectError(ErrorKind::Input, said, [&] { read(bytes); });
        expectError(ErrorKind::Input, "a.nrrd", [&] { read(bytes); });
    }
    const TempDir dir;
};

TEST_F(Nrrd, SaysTheSameInEachEncoding) {
    std::string text;
    for (int i = 0; i < 24; ++i) text += std::to_string(i) + (i % 5 ? " " : ",\n");
    for (const std::string& bytes : {header("encoding: raw\nendian: little\n") + shorts(24),
                                     header("encoding: raw\nendian: big\n") + shorts(24, true),
                                     header("encoding: gzip\nendian: little\n") + gzip(shorts(24)),
                                     header("encoding: ascii\n") + text}) {
        const DenseVolume volume = read(bytes);
        EXPECT_EQ(volume.dims, (Dims{2, 3, 4}));
        EXPECT_EQ(valueAt(volume, {1, 0, 0}), 1);
        EXPECT_EQ(valueAt(volume, {0, 1, 0}), 2);
        EXPECT_EQ(valueAt(volume, {0, 0, 1}), 6);
        EXPECT_EQ(valueAt(volume, {1, 2, 3}), 23);
    }
}

TEST_F(Nrrd, TheOriginIsTheCentreOfTheFirstVoxel) {
    const DenseVolume volume =
        read(header("encoding: raw\nendian: little\nspace: left-posterior-superior\n"
                    "space directions: (0.5,0,0) (0,0,2) (0,-1, 0)\nspace origin: (10,20,30)\n") +
             shorts(24));
    // The world is right-anterior-superior: left and posterior point against it.
    EXPECT_EQ(volume.worldFromIndex.point({1, 2, 3}), (Vec3d{-10.5, -17, 34}));
    const DenseVolume spaced =
        read(header("encoding: raw\nendian: little\nspacings: 1 2 3\n") + shorts(24));
    EXPECT_EQ(spaced.worldFromIndex.point({1, 1, 1}), (Vec3d{1, 2, 3}));
}

/// One body, told in several spaces, lies in one place of the world.
TEST_F(Nrrd, SpacesMeetInOneWorld) {
    const auto at = [&](const std::string& space, const std::string& directions,
                        const std::string& origin) {
        const DenseVolume volume =
            read(header("encoding: raw\nendian: little\nspace: " + space +
                        "\nspace directions: " + directions + "\nspace origin: " + origin + "\n") +
                 shorts(24));
        return volume.worldFromIndex.point({1, 2, 3});
    };
    const Vec3d place{11, 24, 39};
    EXPECT_EQ(at("right-anterior-superior", "(1,0,0) (0,2,0) (0,0,3)", "(10,20,30)"), place);
    EXPECT_EQ(at("RAS", "(1,0,0) (0,2,0) (0,0,3)", "(10,20,30)"), place);
    EXPECT_EQ(at("left-posterior-superior", "(-1,0,0) (0,-2,0) (0,0,3)", "(-10,-20,30)"), place);
    EXPECT_EQ(at("LPS", "(-1,0,0) (0,-2,0) (0,0,3)", "(-10,-20,30)"), place);
    EXPECT_EQ(at("left-anterior-superior", "(-1,0,0) (0,2,0) (0,0,3)", "(-10,20,30)"), place);
    EXPECT_EQ(at("LAS", "(-1,0,0) (0,2,0) (0,0,3)", "(-10,20,30)"), place);
    EXPECT_EQ(at("scanner-xyz", "(1,0,0) (0,2,0) (0,0,3)", "(10,20,30)"), place);
    EXPECT_EQ(at("3D-right-handed", "(1,0,0) (0,2,0) (0,0,3)", "(10,20,30)"), place);
    EXPECT_EQ(at("3D-left-handed", "(1,0,0) (0,2,0) (0,0,-3)", "(10,20,-30)"), place);
    expectRefused(header("encoding: raw\nendian: little\nspace: upside-down\n") + shorts(24),
                  "'upside-down'; expected right-anterior-superior");
    expectRefused(
        header("encoding: raw\nendian: little\nspace: left-right-superior\n") + shorts(24),
        "expected right-anterior-superior");
}

TEST_F(Nrrd, FindsTheAxisOfChannels) {
    const auto four = [](const std::string& sizes, const std::string& more) {
        return "NRRD0004\ntype: short\ndimension: 4\nsizes: " + sizes +
               "\nencoding: raw\nendian: little\n" + more + "\n" + shorts(24);
    };
    const auto expectAxes = [&](const DenseVolume& volume, const Dims& dims, int channels,
                                const std::string& list, double atX) {
        EXPECT_EQ(volume.dims, dims);
        EXPECT_EQ(volume.channels, channels);
        EXPECT_EQ(volume.list, list);
        EXPECT_EQ(valueAt(volume, {1, 0, 0}), atX);  // of the last channel
    };
    // Nothing said: the first, and a note that this is assumed.
    DenseVolume volume = read(four("3 2 2 2", ""));
    expectAxes(volume, {2, 2, 2}, 3, "", 5);
    ASSERT_EQ(volume.notes.size(), 1u);
    EXPECT_NE(volume.notes[0].find("axis 0 is taken for channels"), std::string::npos);
    volume = read(four("2 2 2 3", "kinds: domain domain domain vector\n"));
    expectAxes(volume, {2, 2, 2}, 3, "", 17);
    EXPECT_TRUE(volume.notes.empty());
    expectAxes(read(four("2 2 2 3", "space directions: (1,0,0) (0,1,0) (0,0,1) none\n")), {2, 2, 2},
               3, "", 17);
    expectAxes(read(four("2 3 2 2", "kinds: space RGB-color space space\n")), {2, 2, 2}, 3, "", 5);
    // Times and lists are volumes of their own, wherever they stand.
    expectAxes(read(four("2 3 1 4", "kinds: space space space time\n")), {2, 3, 1}, 4, "times", 19);
    expectAxes(read(four("2 4 3 1", "kinds: list space space space\n")), {4, 3, 1}, 2,
               "entries of a list", 3);
    expectAxes(read(four("2 3 1 4", "space directions: (1,0,0,0) (0,1,0,0) (0,0,1,0) (0,0,0,9)\n")),
               {2, 3, 1}, 4, "times", 19);
    // An axis of one entry says nothing.
    expectAxes(read(four("1 4 3 2", "kinds: vector space space space\n")), {4, 3, 2}, 1, "", 1);
    expectRefused(four("2 3 2 2", "kinds: space space space space\n"), "4 of the NRRD file's 4");
    expectRefused(four("2 3 2 2", "kinds: list space space vector\n"),
                  "neither axis 0 nor axis 3 is an axis of space");
    expectRefused(
        "NRRD0004\ntype: short\ndimension: 5\nsizes: 2 2 2 1 3\nencoding: raw\n"
        "endian: little\nkinds: list space space space vector\n\n" +
            shorts(24),
        "neither axis 0 nor axis 4 is an axis of space");
}

/// The values in other files, as 3D Slicer and ITK write them.
TEST_F(Nrrd, DataMayLieInOtherFiles) {
    const auto expectRead = [&](const std::string& more) {
        const DenseVolume volume = read(header(more));
        EXPECT_TRUE(volume.notes.empty());
        EXPECT_EQ(valueAt(volume, {1, 0, 0}), 1) << more;
        EXPECT_EQ(valueAt(volume, {1, 2, 3}), 23) << more;
    };
    fs::create_directory(dir / "sub");
    writeText(dir / "sub/v.raw", shorts(24));
    writeText(dir / "head.raw", "two\nlines\n" + std::string("12345") + shorts(24));
    writeText(dir / "v.gz", gzip("123" + shorts(24)));
    for (int i = 0; i < 4; ++i)
        writeText(dir / ("slice.0" + std::to_string(2 * i + 3) + ".raw"),
                  shorts(24).substr(static_cast<std::size_t>(12 * i), 12));
    const std::string raw = "encoding: raw\nendian: little\n";
    expectRead(raw + "data file: sub/v.raw\n");
    expectRead(raw + "datafile: " + (dir / "sub/v.raw").string() + "\n");
    expectRead(raw + "line skip: 2\nbyte skip: 5\ndata file: head.raw\n");
    expectRead(raw + "byte skip: -1\ndata file: head.raw\n");
    expectRead("encoding: gzip\nendian: little\nbyte skip: 3\ndata file: v.gz\n");
    expectRead(raw + "data file: slice.%02d.raw 3 9 2\n");
    // The list has no empty line before it, and the header needs none.
    const std::string list =
        raw + "data file: LIST\nslice.03.raw\nslice.05.raw\nslice.07.raw\nslice.09.raw\n";
    EXPECT_EQ(valueAt(read(header(list)), {1, 2, 3}), 23);
    const std::string whole = header(raw + "data file: sub/v.raw\n");
    EXPECT_EQ(valueAt(read(whole.substr(0, whole.size() - 1)), {1, 2, 3}), 23);

    expectRefused(header(raw + "data file: none.raw\n"), "none.raw does not exist");
    expectRefused(header(raw + "data file: slice.03.raw\n"),
                  "slice.03.raw is too short: its values take 48 bytes, and it has 12");
    expectRefused(header(raw + "data file: slice.%02d.raw 3 11 2\n"), "among 5 data files");
    expectRefused(header(raw + "data file: slice.%02d.raw 3 9 0\n"), "FIRST LAST STEP");
    expectRefused(header(raw + "data file: slice.%s.raw 3 9 2\n"), "FIRST LAST STEP");
    expectRefused(header(raw + "data file: LIST\n"), "names of files below it");
    expectRefused(header(raw + "byte skip: -2\ndata file: head.raw\n"), "0 or more");
}

/// As teem takes it: what follows the values is no fault, and said.
TEST_F(Nrrd, WhatFollowsTheValuesIsIgnoredAndSaid) {
    for (const std::string& bytes : {header("encoding: raw\nendian: little\n") + shorts(25),
                                     header("encoding: gzip\nendian: little\n") + gzip(shorts(25)),
                                     header("encoding: ascii\n") + [] {
                                         std::string text;
                                         for (int i = 0; i < 25; ++i)
                                             text += std::to_string(i) + " ";
                                         return text;
                                     }()}) {
        const DenseVolume volume = read(bytes);
        EXPECT_EQ(valueAt(volume, {1, 2, 3}), 23);
        ASSERT_EQ(volume.notes.size(), 1u);
        EXPECT_NE(volume.notes[0].find("after its values are ignored"), std::string::npos);
    }
}

TEST_F(Nrrd, IsReadAsWritten) {
    DenseVolume volume = read(header("encoding: raw\nendian: big\n") + shorts(24, true));
    volume.worldFromIndex = Affine3d::translate({0.1, 1.0 / 3, -7}) * Affine3d::rotate(0, 20) *
                            Affine3d::scale({0.3, 0.4, 0.5});
    writeNrrd(dir / "b.nrrd", volume, {});
    const DenseVolume again = readNrrd(dir / "b.nrrd");
    EXPECT_EQ(again.worldFromIndex, volume.worldFromIndex);
    EXPECT_EQ(again.type, SampleType::I16);
    const std::string bytes = readText(dir / "b.nrrd");
    EXPECT_EQ(bytes.substr(bytes.size() - 48), shorts(24));
}

TEST_F(Nrrd, DamagedFilesAreRefused) {
    for (const std::string& whole :
         {header("encoding: raw\nendian: little\n") + shorts(24),
          header("encoding: gzip\nendian: little\n") + gzip(shorts(24))}) {
        read(whole);
        for (std::size_t n = 0; n < whole.size(); ++n) expectRefused(whole.substr(0, n), "");
    }
    expectRefused(header("encoding: raw\nendian: little\n") + shorts(23), "take 48 bytes");
    expectRefused(header("encoding: gzip\nendian: little\n") + gzip(shorts(23)), "hold 46");
    expectRefused(header("encoding: ascii\n") + "1 2 3", "cannot hold");
    expectRefused(header("encoding: ascii\n") + std::string(60, ' ') + "1 2 x", "after 2 of them");
    expectRefused(header("encoding: zip\nendian: little\n"), "expected raw, gzip or ascii");
    expectRefused(header("encoding: bzip2\nendian: little\n"), "unu save -f nrrd -e gzip");
    expectRefused(header("endian: little\n"), "no field 'encoding'");
    expectRefused(header("encoding: raw\n"), "no field 'endian'");
    expectRefused(header("encoding: raw\nendian: little\nspacings: 0 1 1\n") + shorts(24), "plane");
    expectRefused(header("encoding: raw\nendian: little\nspacings: 1 1\n"), "spacings");
    expectRefused(header("encoding: raw\nendian: little\nspace directions: (1,0) 2 3\n"),
                  "vectors");
    expectRefused(
        "NRRD0004\ntype: float\ndimension: 3\nsizes: 1073741824 1073741824 1073741824\n"
        "encoding: gzip\nendian: little\n\nabc",
        "not a volume");
    expectRefused(
        "NRRD0004\ntype: float\ndimension: 3\nsizes: 1024 1024 1024\n"
        "encoding: gzip\nendian: little\n\nabc",
        "cannot hold");
    expectRefused("NRRD0004\ntype: float\ndimension: 2\nsizes: 2 2\nencoding: raw\n\n",
                  "2 of the NRRD file's 2 axes are axes of space, where 3 are expected");
    expectRefused("NRRD0004\ntype: block\ndimension: 3\nsizes: 1 1 1\nencoding: raw\n\n", "type");
}

}  // namespace
}  // namespace woodcock::test
