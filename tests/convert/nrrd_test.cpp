// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <zlib.h>

#include "tests/support/expect_error.h"
#include "tests/support/temp_dir.h"
#include "woodcock/convert/dense_formats.h"

namespace woodcock::test {
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
    EXPECT_EQ(volume.worldFromIndex.point({1, 2, 3}), (Vec3d{10.5, 17, 34}));
    const DenseVolume spaced =
        read(header("encoding: raw\nendian: little\nspacings: 1 2 3\n") + shorts(24));
    EXPECT_EQ(spaced.worldFromIndex.point({1, 1, 1}), (Vec3d{1, 2, 3}));
}

TEST_F(Nrrd, FindsTheAxisOfChannels) {
    const auto four = [](const std::string& sizes, const std::string& more) {
        return "NRRD0004\ntype: short\ndimension: 4\nsizes: " + sizes +
               "\nencoding: raw\nendian: little\n" + more + "\n" + shorts(24);
    };
    DenseVolume volume = read(four("3 2 2 2", ""));
    EXPECT_EQ(volume.channels, 3);
    EXPECT_EQ(valueAt(volume, {1, 0, 0}), 5);
    volume = read(four("2 2 2 3", "kinds: domain domain domain vector\n"));
    EXPECT_EQ(volume.channels, 3);
    EXPECT_EQ(valueAt(volume, {1, 0, 0}), 17);
    volume = read(four("2 2 2 3", "space directions: (1,0,0) (0,1,0) (0,0,1) none\n"));
    EXPECT_EQ(volume.channels, 3);
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
    expectRefused(header("encoding: raw\nendian: little\n") + shorts(25), "48 bytes");
    expectRefused(header("encoding: gzip\nendian: little\n") + gzip(shorts(25)), "hold more");
    expectRefused(header("encoding: gzip\nendian: little\n") + gzip(shorts(23)), "hold 46");
    expectRefused(header("encoding: ascii\n") + "1 2 3", "cannot hold");
    expectRefused(header("encoding: ascii\n") + std::string(60, ' ') + "1 2 x", "after 2 of them");
    expectRefused(header("encoding: hex\nendian: little\n"), "expected raw, gzip or ascii");
    expectRefused(header("endian: little\n"), "no field 'encoding'");
    expectRefused(header("encoding: raw\n"), "no field 'endian'");
    expectRefused(header("encoding: raw\nendian: little\ndata file: other.raw\n"), "datafile");
    expectRefused(header("encoding: raw\nendian: little\nspacings: 0 1 1\n") + shorts(24), "plane");
    expectRefused(header("encoding: raw\nendian: little\nspacings: 1 1\n"), "spacings");
    expectRefused(header("encoding: raw\nendian: little\nspace directions: (1,0) 2 3\n"),
                  "vectors");
    expectRefused(
        "NRRD0004\ntype: float\ndimension: 3\nsizes: 1073741824 1073741824 1073741824\n"
        "encoding: gzip\nendian: little\n\nabc",
        "no volume");
    expectRefused(
        "NRRD0004\ntype: float\ndimension: 3\nsizes: 1024 1024 1024\n"
        "encoding: gzip\nendian: little\n\nabc",
        "cannot hold");
    expectRefused("NRRD0004\ntype: float\ndimension: 2\nsizes: 2 2\nencoding: raw\n\n",
                  "dimension");
    expectRefused("NRRD0004\ntype: block\ndimension: 3\nsizes: 1 1 1\nencoding: raw\n\n", "type");
}

}  // namespace
}  // namespace woodcock::test
