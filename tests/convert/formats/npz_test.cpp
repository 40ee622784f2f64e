// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <zlib.h>

#include "tests/support/expect_error.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/convert/formats/dense_formats.h"

namespace woodcock::test {

using namespace convert;
namespace {

struct Entry {
    std::string name, bytes;
    bool deflated = false;
};

template <class T>
std::string little(T value) {
    std::string bytes;
    for (std::size_t i = 0; i < sizeof value; ++i)
        bytes += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 255);
    return bytes;
}
std::string u16(unsigned v) { return little(static_cast<std::uint16_t>(v)); }
std::string u32(std::size_t v) { return little(static_cast<std::uint32_t>(v)); }
std::string u64(std::size_t v) { return little(static_cast<std::uint64_t>(v)); }

std::string deflate(const std::string& bytes) {
    z_stream stream{};
    deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 9, Z_DEFAULT_STRATEGY);
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

/// As NumPy writes it (its local headers have numbers of 64 bits); `wide`: the directory as well.
std::string zip(const std::vector<Entry>& entries, bool wide = false) {
    std::string bytes, directory;
    for (const Entry& e : entries) {
        const std::string stored = e.deflated ? deflate(e.bytes) : e.bytes;
        const std::size_t sum =
            crc32_z(0, reinterpret_cast<const Bytef*>(e.bytes.data()), e.bytes.size());
        const std::size_t header = bytes.size();
        const std::string how = u16(0) + u16(e.deflated ? 8 : 0) + u32(0) + u32(sum);
        bytes += u32(0x04034b50) + u16(45) + how + u32(0xffffffff) + u32(0xffffffff) +
                 u16(static_cast<unsigned>(e.name.size())) + u16(20) + e.name + u16(1) + u16(16) +
                 u64(e.bytes.size()) + u64(stored.size()) + stored;
        const std::string extra =
            wide ? u16(1) + u16(24) + u64(e.bytes.size()) + u64(stored.size()) + u64(header) : "";
        directory +=
            u32(0x02014b50) + u16(45) + u16(45) + how + u32(wide ? 0xffffffff : stored.size()) +
            u32(wide ? 0xffffffff : e.bytes.size()) + u16(static_cast<unsigned>(e.name.size())) +
            u16(static_cast<unsigned>(extra.size())) + u16(0) + std::string(8, '\0') +
            u32(wide ? 0xffffffff : header) + e.name + extra;
    }
    const std::size_t begin = bytes.size(), count = entries.size();
    bytes += directory;
    if (wide) {
        const std::size_t end64 = bytes.size();
        bytes += u32(0x06064b50) + u64(44) + u16(45) + u16(45) + u64(0) + u64(count) + u64(count) +
                 u64(directory.size()) + u64(begin);
        bytes += u32(0x07064b50) + u32(0) + u64(end64) + u32(1);
    }
    const auto entriesThere = static_cast<unsigned>(wide ? 0xffff : count);
    return bytes + u32(0x06054b50) + u32(0) + u16(entriesThere) + u16(entriesThere) +
           u32(directory.size()) + u32(wide ? 0xffffffff : begin) + u16(0);
}

/// array[x, y, z] = first + 0, 1, 2, ...
std::string npy(const std::string& shape, int count, float first) {
    std::string text = "{'descr': '<f4', 'fortran_order': False, 'shape': (" + shape + "), }\n";
    std::string bytes =
        std::string("\x93NUMPY\x01\x00", 8) + u16(static_cast<unsigned>(text.size())) + text;
    for (int i = 0; i < count; ++i) {
        const float v = first + static_cast<float>(i);
        bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
    }
    return bytes;
}

float firstOf(const DenseVolume& volume) {
    float value = 0;
    readBlock(volume, {0, 0, 0}, {1, 1, 1}, &value);
    return value;
}

class Npz : public testing::Test {
protected:
    std::vector<DenseVolume> read(const std::string& bytes,
                                  const std::optional<std::string>& array = {}) const {
        writeText(dir / "a.npz", bytes);
        return readNpz(dir / "a.npz", array);
    }
    void expectRefused(const std::string& said, const std::string& bytes,
                       const std::optional<std::string>& array = {}) const {
        expectError(ErrorKind::Input, said, [&] { read(bytes, array); });
        expectError(ErrorKind::Input, "a.npz", [&] { read(bytes, array); });
    }
    const TempDir dir;
    const std::vector<Entry> two{{"smoke.npy", npy("2, 3, 4", 24, 5), false},
                                 {"voxel.npy", npy("", 1, 0.5f), true},
                                 {"heat.npy", npy("2, 3, 4", 24, 7), true}};
};

TEST_F(Npz, ArraysAreGridsByTheirNames) {
    for (const bool wide : {false, true}) {
        const std::vector<DenseVolume> volumes = read(zip(two, wide));
        ASSERT_EQ(volumes.size(), 2u);
        EXPECT_EQ(volumes[0].name, "smoke");
        EXPECT_EQ(volumes[1].name, "heat");
        EXPECT_EQ(volumes[1].dims, (Dims{2, 3, 4}));
        float last = 0;
        readBlock(volumes[1], {1, 2, 3}, {1, 1, 1}, &last);
        EXPECT_EQ(last, 7 + 23);
        ASSERT_EQ(volumes[0].notes.size(), 1u);
        EXPECT_NE(volumes[0].notes[0].find("'voxel' is left out: an array of shape []"),
                  std::string::npos)
            << volumes[0].notes[0];
        const std::vector<DenseVolume> one = read(zip(two, wide), "heat");
        ASSERT_EQ(one.size(), 1u);
        EXPECT_EQ(firstOf(one[0]), 7);
    }
    EXPECT_EQ(read(zip({{"arr_0.npy", npy("1, 1, 2", 2, 3), true}}))[0].name, "density");
}

TEST_F(Npz, WhatCannotBeGridsIsRefused) {
    expectRefused("did you mean 'heat'", zip(two), "heet");
    expectRefused("an array of 0 dimensions", zip(two), "voxel");
    expectRefused("holds no NumPy array", zip({{"readme.txt", "x", false}}));
    expectRefused("holds no array of three or four dimensions", zip({two[1]}));
    expectRefused("choose one by --grid: smoke, heat",
                  zip({two[0], {"heat.npy", npy("2, 3, 5", 30, 7), true}}));
    expectRefused("need 96 bytes, and there are 92",
                  zip({{"smoke.npy", npy("2, 3, 4", 23, 5), true}}));
    expectRefused("is not a zip archive", "no archive");
}

TEST_F(Npz, DamagedArchivesAreRefused) {
    const std::string whole = zip(two);
    read(whole);
    for (std::size_t n = 0; n < whole.size(); n += 3) expectRefused("", whole.substr(0, n));
    // Any bit: a fault that is found, or one in what is not looked at.
    int errors = 0;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string bytes = whole;
        bytes[i] = static_cast<char>(bytes[i] ^ (1 << i % 8));
        try {
            read(bytes);
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find("a.npz"), std::string::npos) << e.what();
            ++errors;
        }
    }
    EXPECT_GT(errors, static_cast<int>(whole.size() / 3));
    std::string bomb = zip({{"a.npy", npy("2, 3, 4", 24, 5), true}});
    const std::size_t size = bomb.find("\x50\x4b\x01\x02") + 24;
    bomb.replace(size, 4, u32(0x7fffffff));
    expectRefused("cannot unpack to 2147483647", bomb);
}

}  // namespace
}  // namespace woodcock::test
