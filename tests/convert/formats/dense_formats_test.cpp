// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/formats/dense_formats.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "tests/support/expect_error.h"
#include "woodcock/base/temp_dir.h"

namespace woodcock::test {

using namespace convert;
namespace {

namespace fs = std::filesystem;

template <class T>
std::string bytesOf(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::string reversedWords(std::string bytes, std::size_t size) {
    for (std::size_t i = 0; i + size <= bytes.size(); i += size)
        std::reverse(bytes.begin() + std::ptrdiff_t(i), bytes.begin() + std::ptrdiff_t(i + size));
    return bytes;
}

/// All values, x slowest, z fastest, channels innermost.
std::vector<double> valuesOf(const DenseVolume& volume) {
    std::vector<double> values(volume.voxels() * static_cast<std::size_t>(volume.channels));
    readBlock(volume, {0, 0, 0}, volume.dims, values.data());
    return values;
}

/// 0, 1, 2, ... as a file with x the fastest has them, seen with z the fastest.
std::vector<double> countingXFirst(const Dims& dims) {
    std::vector<double> values;
    for (std::int64_t i = 0; i < dims[0]; ++i)
        for (std::int64_t j = 0; j < dims[1]; ++j)
            for (std::int64_t k = 0; k < dims[2]; ++k)
                values.push_back(double(i + dims[0] * (j + dims[1] * k)));
    return values;
}

std::vector<double> counting(std::size_t n) {
    std::vector<double> values(n);
    for (std::size_t i = 0; i < n; ++i) values[i] = double(i);
    return values;
}

template <class T>
std::vector<T> countingAs(std::size_t n) {
    const auto values = counting(n);
    return {values.begin(), values.end()};
}

std::string npy(const std::string& header, const std::string& data, int version = 1) {
    std::string bytes = "\x93NUMPY" + std::string(1, char(version)) + std::string(1, '\0');
    for (int i = 0; i < (version == 1 ? 2 : 4); ++i)
        bytes += static_cast<char>(header.size() >> (8 * i) & 255);
    return bytes + header + data;
}

std::string npyHeader(const std::string& type, const std::string& order, const std::string& shape) {
    return "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }\n";
}

std::string vol(const std::vector<std::int32_t>& numbers, const std::vector<float>& box,
                const std::string& data) {
    return "VOL\x03" + bytesOf(numbers) + bytesOf(box) + data;
}

class DenseFormats : public testing::Test {
protected:
    fs::path file(const std::string& name, const std::string& bytes) const {
        writeText(dir / name, bytes);
        return dir / name;
    }
    /// No beginning of the file but the whole is a volume, and each is refused by name.
    void expectPrefixesRefused(const std::string& whole,
                               const std::function<void(const fs::path&)>& read) const {
        read(file("damaged", whole));
        for (std::size_t n = 0; n < whole.size(); ++n) {
            const fs::path cut = file("damaged", whole.substr(0, n));
            expectError(ErrorKind::Input, "damaged", [&] { read(cut); });
        }
        expectError(ErrorKind::Input, "damaged",
                    [&] { read(file("damaged", whole + "12345678")); });
    }
    const TempDir dir;
};

TEST_F(DenseFormats, RawOfEachType) {
    const Dims dims{2, 3, 4};
    const auto check = [&]<class T>(SampleType type, T) {
        const std::string data = bytesOf(countingAs<T>(24));
        const DenseVolume little = readRaw(file("a.raw", data), {.dims = dims, .type = type});
        EXPECT_EQ(valuesOf(little), countingXFirst(dims)) << sampleTypeName(type);
        const DenseVolume big =
            readRaw(file("a.raw", "head" + reversedWords(data, sizeof(T))),
                    {.dims = dims, .type = type, .bigEndian = true, .headerBytes = 4});
        EXPECT_EQ(valuesOf(big), countingXFirst(dims)) << sampleTypeName(type);
        EXPECT_EQ(writeRaw(dir / "b.raw", little, {}), 0);
        EXPECT_EQ(readText(dir / "b.raw"), data) << sampleTypeName(type);
    };
    check(SampleType::U8, std::uint8_t{});
    check(SampleType::I8, std::int8_t{});
    check(SampleType::U16, std::uint16_t{});
    check(SampleType::I16, std::int16_t{});
    check(SampleType::U32, std::uint32_t{});
    check(SampleType::I32, std::int32_t{});
    check(SampleType::U64, std::uint64_t{});
    check(SampleType::I64, std::int64_t{});
    check(SampleType::F32, float{});
    check(SampleType::F64, double{});
}

TEST_F(DenseFormats, HalvesOfEveryKind) {
    // 1, -2, largest, smallest normal, smallest denormal, infinity, NaN, -0: IEEE 754.
    const std::vector<std::uint16_t> bits{0x3c00, 0xc000, 0x7bff, 0x0400,
                                          0x0001, 0x7c00, 0x7e00, 0x8000};
    const auto values = valuesOf(
        readRaw(file("a.raw", bytesOf(bits)), {.dims = {1, 1, 8}, .type = SampleType::F16}));
    EXPECT_EQ(values[0], 1);
    EXPECT_EQ(values[1], -2);
    EXPECT_EQ(values[2], 65504);
    EXPECT_EQ(values[3], std::ldexp(1.0, -14));
    EXPECT_EQ(values[4], std::ldexp(1.0, -24));
    EXPECT_EQ(values[5], std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::isnan(values[6]));
    EXPECT_EQ(values[7], 0);
}

TEST_F(DenseFormats, RawOfAnotherSizeGetsAHint) {
    const fs::path a = file("a.raw", std::string(4 * 4 * 4 * 2, 'a'));
    const auto message = [&](const RawLayout& layout) {
        return messageOf(ErrorKind::Input, [&] { readRaw(a, layout); });
    };
    const std::string wrongType = message({.dims = {4, 4, 4}, .type = SampleType::F32});
    EXPECT_NE(wrongType.find("256 bytes"), std::string::npos) << wrongType;
    EXPECT_NE(wrongType.find("128"), std::string::npos) << wrongType;
    EXPECT_NE(wrongType.find("u16"), std::string::npos) << wrongType;
    const std::string wrongSide = message({.dims = {4, 4, 5}, .type = SampleType::U16});
    EXPECT_NE(wrongSide.find("4 x 4 x 4 would fit"), std::string::npos) << wrongSide;
    const std::string header = message({.dims = {11, 11, 1}, .type = SampleType::U8});
    EXPECT_NE(header.find("header of 7 bytes"), std::string::npos) << header;
    EXPECT_NE(message({.dims = {4, 4, 4}, .headerBytes = 1000}).find("--header gives 1000"),
              std::string::npos);
    EXPECT_NE(message({.dims = {0, 4, 4}}).find("not a volume"), std::string::npos);
    EXPECT_NE(message({.dims = {1 << 30, 1 << 30, 1 << 30}}).find("not a volume"),
              std::string::npos);
}

TEST_F(DenseFormats, NpyInBothOrdersAndEnds) {
    const std::string data = bytesOf(countingAs<float>(24));
    for (int version : {1, 2, 3})
        EXPECT_EQ(valuesOf(readNpy(
                      file("a.npy", npy(npyHeader("<f4", "False", "(2, 3, 4)"), data, version)))),
                  counting(24));
    EXPECT_EQ(valuesOf(readNpy(file("a.npy", npy(npyHeader("<f4", "True", "(2, 3, 4)"), data)))),
              countingXFirst({2, 3, 4}));
    EXPECT_EQ(valuesOf(readNpy(file(
                  "a.npy", npy(npyHeader(">f4", "False", "(2, 3, 4)"), reversedWords(data, 4))))),
              counting(24));
    const DenseVolume colour =
        readNpy(file("a.npy", npy(npyHeader("<f4", "False", "(2, 2, 2, 3)"), data)));
    EXPECT_EQ(colour.channels, 3);
    EXPECT_EQ(valuesOf(colour), counting(24));
    const DenseVolume fortran =
        readNpy(file("a.npy", npy(npyHeader("<f4", "True", "(2, 2, 2, 3)"), data)));
    EXPECT_EQ(valuesOf(fortran)[1], 8);  // channel 1 of voxel (0, 0, 0)
    EXPECT_EQ(valuesOf(selectChannel(fortran, 2))[4], 17);
}

TEST_F(DenseFormats, NpyIsWrittenAsRead) {
    for (const char* shape : {"(2, 3, 4)", "(2, 2, 2, 3)"}) {
        const std::string data = bytesOf(countingAs<double>(24));
        const DenseVolume volume =
            readNpy(file("a.npy", npy(npyHeader("<f8", "False", shape), data)));
        writeNpy(dir / "b.npy", volume, {});
        const DenseVolume again = readNpy(dir / "b.npy");
        EXPECT_EQ(again.type, SampleType::F64);
        EXPECT_EQ(again.dims, volume.dims);
        EXPECT_EQ(valuesOf(again), counting(24));
        EXPECT_EQ((readText(dir / "b.npy").size() - data.size()) % 64, 0u);
    }
}

TEST_F(DenseFormats, DamagedNpyIsRefused) {
    expectPrefixesRefused(
        npy(npyHeader("<f4", "False", "(1, 2, 3)"), bytesOf(countingAs<float>(6))),
        [](const fs::path& path) { readNpy(path); });
    const auto refused = [&](const std::string& header, const std::string& said) {
        expectError(ErrorKind::Input, said, [&] { readNpy(file("a.npy", npy(header, "1234"))); });
    };
    refused(npyHeader("<f4", "False", "(1, 1)"), "dimensions");
    refused(npyHeader("<f4", "False", "(-1, 1, 1)"), "not a volume");
    refused(npyHeader("<f4", "False", "(99999999999999999999, 1, 1)"), "whole numbers");
    refused(npyHeader("<f4", "False", "(1073741824, 1073741824, 1073741824)"), "not a volume");
    refused(npyHeader("<f4", "Maybe", "(1, 1, 1)"), "fortran_order");
    refused(npyHeader("<c8", "False", "(1, 1, 1)"), "known");
    refused(npyHeader("", "False", "(1, 1, 1)"), "known");
    refused("{'descr': [('a', '<f4')], 'fortran_order': False, 'shape': (1,1,1)}", "descr");
    refused("{'descr': '<f4'}", "no 'shape'");
    refused("", "descr");
}

TEST_F(DenseFormats, MitsubaPlacesCentresOfCells) {
    const DenseVolume volume = readMitsubaVolume(
        file("a.vol", vol({1, 2, 3, 4, 1}, {1, 2, 3, 3, 5, 7}, bytesOf(countingAs<float>(24)))));
    EXPECT_EQ(valuesOf(volume), countingXFirst({2, 3, 4}));
    EXPECT_EQ(volume.worldFromIndex.point({0, 0, 0}), (Vec3d{1.5, 2.5, 3.5}));
    EXPECT_EQ(volume.worldFromIndex.point({1, 2, 3}), (Vec3d{2.5, 4.5, 6.5}));
    writeMitsubaVolume(dir / "b.vol", volume, {});
    EXPECT_EQ(readText(dir / "b.vol"), readText(dir / "a.vol"));
}

TEST_F(DenseFormats, OldMitsubaEncodings) {
    const DenseVolume bytes = readMitsubaVolume(
        file("a.vol", vol({3, 1, 1, 2, 1}, {0, 0, 0, 1, 1, 1}, std::string("\x00\xff", 2))));
    EXPECT_EQ(valuesOf(bytes), (std::vector<double>{0, 1}));
    const DenseVolume halves =
        readMitsubaVolume(file("a.vol", vol({2, 1, 1, 2, 1}, {0, 0, 0, 1, 1, 1},
                                            bytesOf<std::uint16_t>({0x3800, 0x4000}))));
    EXPECT_EQ(valuesOf(halves), (std::vector<double>{0.5, 2}));
}

TEST_F(DenseFormats, DamagedMitsubaVolumesAreRefused) {
    const auto read = [](const fs::path& path) { readMitsubaVolume(path); };
    const std::vector<float> box{0, 0, 0, 1, 1, 1};
    expectPrefixesRefused(vol({1, 1, 2, 3, 1}, box, bytesOf(countingAs<float>(6))), read);
    const auto refused = [&](const std::string& bytes, const std::string& said) {
        expectError(ErrorKind::Input, said, [&] { read(file("a.vol", bytes)); });
    };
    refused("LOV\x03", "VOL");
    refused("VOL\x04", "version 4");
    refused(vol({4, 1, 1, 1, 1}, box, "1234"), "encoding 4");
    refused(vol({1, -1, 1, 1, 1}, box, "1234"), "not a volume");
    refused(vol({1, 1, 1, 1, -1}, box, "1234"), "not a volume");
    refused(vol({1, 1 << 30, 1 << 30, 1 << 30, 1 << 30}, box, "1234"), "not a volume");
}

/// Mitsuba does not look at the box, and fills the unit cube.
TEST_F(DenseFormats, MitsubaVolumesWithoutABoxFillTheUnitCube) {
    std::vector<float> integers(6);
    const std::vector<std::int32_t> whole{0, 0, 0, 25, 25, 25};
    std::memcpy(integers.data(), whole.data(), sizeof(float) * 6);
    const auto expectCube = [&](const std::vector<float>& box) {
        const DenseVolume volume = readMitsubaVolume(
            file("a.vol", vol({1, 2, 4, 5, 1}, box, bytesOf(countingAs<float>(40)))));
        EXPECT_TRUE(volume.unitCube);
        EXPECT_FALSE(volume.placed);
        EXPECT_EQ(volume.notes.size(), 1u);
        EXPECT_EQ(volume.worldFromIndex.point({-0.5, -0.5, -0.5}), (Vec3d{0, 0, 0}));
        EXPECT_EQ(volume.worldFromIndex.point({1.5, 3.5, 4.5}), (Vec3d{1, 1, 1}));
        EXPECT_EQ(valuesOf(volume), countingXFirst({2, 4, 5}));
    };
    expectCube({0, 0, 0, 0, 0, 0});
    expectCube({0, 0, 0, 0, 1, 1});
    expectCube({0, 0, 0, NAN, 1, 1});
    expectCube({1, 1, 1, 0, 0, 0});
    expectCube(integers);
}

TEST_F(DenseFormats, WritersRefuseWhatATypeCannotHold) {
    DenseVolume volume = readRaw(file("a.raw", bytesOf<float>({0, 0.25f, 300, -1})),
                                 {.dims = {4, 1, 1}, .type = SampleType::F32});
    expectError(ErrorKind::Input, "voxel [2, 0, 0]",
                [&] { writeRaw(dir / "b.raw", volume, {.type = SampleType::U8}); });
    EXPECT_FALSE(fs::exists(dir / "b.raw"));
    // The nearest whole numbers, and how far they are.
    EXPECT_EQ(writeRaw(dir / "b.raw", volume, {.type = SampleType::I16}), 0.25);
    EXPECT_EQ(readText(dir / "b.raw"), bytesOf<std::int16_t>({0, 0, 300, -1}));
    volume.worldFromIndex = Affine3d::rotate(2, 30);
    expectError(ErrorKind::Input, "rotated",
                [&] { writeMitsubaVolume(dir / "b.vol", volume, {}); });
    EXPECT_FALSE(fs::exists(dir / "b.vol"));
}

}  // namespace
}  // namespace woodcock::test
