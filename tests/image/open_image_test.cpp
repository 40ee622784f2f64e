// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstring>
#include <random>

#include "tests/support/expect_error.h"
#include "tests/support/paths.h"
#include "tests/support/write_image.h"
#include "woodcock/image/openimageio_input.h"
#include "woodcock/image/read_image.h"
#include "woodcock/image/read_layers.h"

namespace woodcock::test {

using namespace image;
namespace {

namespace fs = std::filesystem;

struct Format {
    const char* name;  ///< OpenImageIO's
    const char* ending;
    double tolerance;  ///< of a picture of smooth greys
};
constexpr Format formats[]{
    {"openexr", ".exr", 0},  {"png", ".png", 0.003}, {"jpeg", ".jpg", 0.03},
    {"tiff", ".tif", 0.003}, {"hdr", ".hdr", 0.01},  {"webp", ".webp", 0.05},
    {"pnm", ".ppm", 0.003},  {"bmp", ".bmp", 0.003}, {"targa", ".tga", 0.003}};

constexpr int width = 24, height = 16;

float valueAt(int x, int y) {
    return 0.2f + 0.02f * static_cast<float>(x) + 0.01f * static_cast<float>(y);
}

/// False where this OpenImageIO does not write the format.
bool write(const fs::path& file, const Format& format) {
    const auto out = OIIO::ImageOutput::create(format.name);
    if (!out) return false;
    const bool floats = std::string(format.name) == "openexr" || std::string(format.name) == "hdr";
    const OIIO::ImageSpec spec(width, height, 3,
                               floats ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
    std::vector<float> pixels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) pixels.insert(pixels.end(), 3, valueAt(x, y));
    return out->open(file.string(), spec) &&
           out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) && out->close();
}

TEST(OpenImage, TheFormatsThatAreReadAre) {
    const TempDir dir;
    for (const Format& format : formats) {
        const fs::path file = dir / (std::string("a") + format.ending);
        if (!write(file, format)) {
            std::printf("this OpenImageIO writes no %s\n", format.name);
            continue;
        }
        const Image image = readImage(file);
        ASSERT_EQ(image.width, width) << format.name;
        ASSERT_EQ(image.height, height) << format.name;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                ASSERT_NEAR(image.at(x, y)[1], valueAt(x, y), format.tolerance + 1e-6)
                    << format.name << " " << x << " " << y;
    }
}

TEST(OpenImage, ContentsTellTheFormatNotTheName) {
    const TempDir dir;
    ASSERT_TRUE(write(dir / "a.png", formats[1]));
    fs::rename(dir / "a.png", dir / "a.jpg");
    EXPECT_EQ(readImage(dir / "a.jpg").width, width);
}

std::string refusal(const fs::path& file) {
    return messageOf(ErrorKind::Input, [&] { readLayers(file); });
}

TEST(OpenImage, OtherFormatsAreRefusedByName) {
    const TempDir dir;
    // OpenImageIO would read each of these: the first beyond its own list of channels.
    const std::string card = "SIMPLE  =                    T";
    writeText(dir / "a.fits", card + std::string(2880 - card.size(), ' '));
    writeText(dir / "a.dpx", "SDPX" + std::string(2044, '\0'));
    writeText(dir / "a.gif", "GIF89a" + std::string(100, '\0'));
    writeText(dir / "a.mp4", std::string("\0\0\0\x18", 4) + "ftypmp42" + std::string(100, '\0'));
    for (const char* name : {"a.fits", "a.dpx", "a.gif", "a.mp4"})
        EXPECT_NE(refusal(dir / name).find("its format is not one that woodcock reads (OpenEXR, "),
                  std::string::npos)
            << refusal(dir / name);
    writeText(dir / "a.dcm", std::string(128, '\0') + "DICM" + std::string(100, '\0'));
    EXPECT_NE(refusal(dir / "a.dcm").find("it is a DICOM image"), std::string::npos);
    writeText(dir / "empty.png", "");
    EXPECT_NE(refusal(dir / "empty.png").find("it is empty"), std::string::npos);
}

TEST(OpenImage, WaitsForNothing) {
    const TempDir dir;
    ASSERT_EQ(mkfifo((dir / "pipe.png").c_str(), 0600), 0);
    EXPECT_NE(refusal(dir / "pipe.png").find("it is a pipe"), std::string::npos);
    EXPECT_NE(refusal("/dev/zero").find("it is a device"), std::string::npos);
    writeText(dir / "sparse.exr", "");
    fs::resize_file(dir / "sparse.exr", std::uintmax_t{1} << 40);
    EXPECT_NE(refusal(dir / "sparse.exr").find("its format is not one"), std::string::npos);
}

/// A header that claims a vast picture, at `place`, of a small file.
void claim(const fs::path& file, std::size_t place, std::string bytes) {
    std::string whole = readText(file);
    ASSERT_LE(place + bytes.size(), whole.size());
    whole.replace(place, bytes.size(), bytes);
    writeText(file, whole);
}

std::string bigEndian(std::uint32_t v) {
    return {static_cast<char>(v >> 24), static_cast<char>(v >> 16), static_cast<char>(v >> 8),
            static_cast<char>(v)};
}
std::string littleEndian(std::uint32_t v) {
    const std::string b = bigEndian(v);
    return {b.rbegin(), b.rend()};
}

TEST(OpenImage, SizesAreHeldAgainstTheFile) {
    const TempDir dir;
    for (const Format& format : formats)
        if (!write(dir / (std::string("a") + format.ending), format))
            GTEST_SKIP() << "this OpenImageIO writes no " << format.name;
    const auto refused = [&](const char* name) {
        EXPECT_NE(refusal(dir / name).find("cannot hold so much"), std::string::npos)
            << refusal(dir / name);
    };
    claim(dir / "a.png", 16, bigEndian(60000) + bigEndian(60000));
    refused("a.png");
    claim(dir / "a.bmp", 18, littleEndian(60000) + littleEndian(60000));
    refused("a.bmp");
    claim(dir / "a.tga", 12, littleEndian(60000u << 16 | 60000));
    refused("a.tga");
    const std::string jpeg = readText(dir / "a.jpg");
    const std::size_t frame = jpeg.find("\xff\xc0");
    ASSERT_NE(frame, std::string::npos);
    claim(dir / "a.jpg", frame + 5, bigEndian(60000u << 16 | 60000));
    refused("a.jpg");
    writeText(dir / "a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 60000\n");
    refused("a.hdr");
    writeText(dir / "a.pgm", "P5\n# remark\n60000 60000 255\n");
    refused("a.pgm");
}

/// A small EXR with an attribute's bytes replaced.
std::string exrWith(const std::string& whole, const std::string& name, const std::string& bytes) {
    std::string changed = whole;
    const std::size_t at = whole.find(name + '\0');
    EXPECT_NE(at, std::string::npos) << name;
    const std::size_t type = at + name.size() + 1, data = whole.find('\0', type) + 5;
    return changed.replace(data, bytes.size(), bytes);
}

TEST(OpenImage, ExrHeadersAreHeldAgainstTheFile) {
    const TempDir dir;
    writeImage(dir / "a.exr", {});
    const std::string whole = readText(dir / "a.exr");
    const auto said = [&](const std::string& bytes) {
        writeText(dir / "b.exr", bytes);
        return refusal(dir / "b.exr");
    };
    const auto window = [](std::uint32_t w, std::uint32_t h) {
        return littleEndian(0) + littleEndian(0) + littleEndian(w - 1) + littleEndian(h - 1);
    };
    EXPECT_NE(said(exrWith(whole, "dataWindow", window(1 << 20, 1 << 10))).find("cannot hold"),
              std::string::npos);
    // Small pictures, but a table that the file has no room for.
    EXPECT_NE(said(exrWith(whole, "dataWindow", window(1, 1 << 20))).find("table of"),
              std::string::npos);
    // A chunk of one line of 16 is held as 16 lines.
    EXPECT_NE(said(exrWith(whole, "dataWindow", window(1 << 20, 1))).find("cannot hold"),
              std::string::npos);
    EXPECT_NE(said(exrWith(whole, "dataWindow", window(0, 1))).find("window of pixels is empty"),
              std::string::npos);
    EXPECT_NE(said(exrWith(whole, "compression", "\x7f")).find("number 127, is not known"),
              std::string::npos);
    // An attribute that claims two gigabytes, and one whose own sizes do.
    std::string greedy = whole;
    const std::size_t end = greedy.find(std::string("capDate"));
    const std::size_t at = end != std::string::npos ? end : greedy.find("compression");
    const std::string more = std::string("many\0string\0", 12) + littleEndian(0x7fffffff);
    EXPECT_NE(said(greedy.substr(0, at) + more + greedy.substr(at)).find("2147483647 bytes where"),
              std::string::npos);
    const std::string list =
        std::string("list\0stringvector\0", 18) + littleEndian(4) + littleEndian(0x7ffffff0);
    EXPECT_NE(said(greedy.substr(0, at) + list + greedy.substr(at)).find("do not fit its type"),
              std::string::npos);
    const std::string preview = std::string("preview\0preview\0", 16) + littleEndian(8) +
                                littleEndian(40000) + littleEndian(40000);
    EXPECT_NE(said(greedy.substr(0, at) + preview + greedy.substr(at)).find("do not fit its type"),
              std::string::npos);
}

// Whatever the damage, a picture or one error of the input: no crash, and no other exception.
TEST(OpenImage, DamagedHeadersAreReadOrRefused) {
    const TempDir dir;
    std::mt19937 random(1);
    const auto number = [&](std::size_t most) { return random() % most; };
    for (const Format& format : formats) {
        const fs::path file = dir / (std::string("a") + format.ending);
        if (!write(file, format)) continue;
        const std::string whole = readText(file);
        int refused = 0;
        for (int i = 0; i < 150; ++i) {
            std::string bytes = whole;
            const std::size_t header = std::min<std::size_t>(bytes.size(), i % 2 ? 64 : 400);
            for (std::size_t n = 1 + number(4); n > 0; --n)
                bytes[number(header)] =
                    static_cast<char>(number(3) ? number(256) : (number(2) ? 0xff : 0));
            if (i % 5 == 0) bytes.resize(number(bytes.size()));
            writeText(file, bytes);
            try {
                readLayers(file);
            } catch (const Error& e) {
                ++refused;
                EXPECT_EQ(e.kind(), ErrorKind::Input) << format.name << " " << i << e.what();
                EXPECT_NE(std::string(e.what()).find(file.string()), std::string::npos) << e.what();
            }
        }
        EXPECT_GT(refused, 10) << format.name;
    }
}

}  // namespace
}  // namespace woodcock::test
