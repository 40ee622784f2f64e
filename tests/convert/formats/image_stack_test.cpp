// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/expect_error.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/convert/formats/dense_formats.h"
#include "woodcock/proof/support/read_back.h"

namespace woodcock::test {

using namespace convert;
using namespace proof;

namespace {

class ImageStack : public testing::Test {
protected:
    void write(const std::string& name, int width = 2, int height = 2, float first = 0) const {
        std::vector<float> values(static_cast<std::size_t>(width * height));
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = first + static_cast<float>(i);
        writeFloats(dir / name, width, height, 1, values);
    }
    const TempDir dir;
};

TEST_F(ImageStack, StandsUpright) {
    for (int z = 0; z < 3; ++z)
        write("slice.000" + std::to_string(8 + z) + ".exr", 2, 2, 10.0f * static_cast<float>(z));
    // Not padded to four digits: another sequence.
    EXPECT_EQ(readImageStack(dir / "slice.#####.exr", {}).dims, (Dims{2, 2, 1}));
    std::filesystem::rename(dir / "slice.00010.exr", dir / "slice.0010.exr");
    for (const char* pattern : {"slice.####.exr", "slice.%04d.exr"}) {
        const DenseVolume volume = readImageStack(dir / pattern, {});
        ASSERT_EQ(volume.dims, (Dims{2, 2, 3}));
        std::vector<double> values(12);
        readBlock(volume, {0, 0, 0}, volume.dims, values.data());
        // Rows from the bottom: y = 0 is the second row of a picture.
        EXPECT_EQ(values, (std::vector<double>{2, 12, 22, 0, 10, 20, 3, 13, 23, 1, 11, 21}));
    }
}

TEST_F(ImageStack, BytesAreFractions) {
    writeFloats(dir / "a1.png", 1, 1, 1, {0.2f});
    float value = 0;
    readBlock(readImageStack(dir / "a#.png", {}), {0, 0, 0}, {1, 1, 1}, &value);
    EXPECT_FLOAT_EQ(value, 51 / 255.0f);
}

TEST_F(ImageStack, NamesWhatIsMissingOrUnlike) {
    const auto refused = [&](const std::string& said) {
        expectError(ErrorKind::Input, said, [&] { readImageStack(dir / "s.##.exr", {}); });
    };
    refused("there are no files");
    for (const char* n : {"01", "02", "04", "08"}) write(std::string("s.") + n + ".exr");
    refused("between 1 and 8: 3, 5 to 7");
    for (const char* n : {"03", "05", "06"}) write(std::string("s.") + n + ".exr");
    write("s.07.exr", 3, 2);
    refused("s.07.exr' is 3 x 2");
    writeText(dir / "s.07.exr", "not a picture");
    refused("s.07.exr");
}

TEST_F(ImageStack, AListIsSortedByItsNumbers) {
    for (const int n : {8, 9, 10})
        write("cut2.slice" + std::to_string(n) + ".exr", 2, 2, 10.0f * static_cast<float>(n));
    const auto file = [&](const char* name) { return dir / name; };
    // As a shell lists them: 10 before 8.
    const DenseVolume volume = readImageFiles(
        {file("cut2.slice10.exr"), file("cut2.slice8.exr"), file("cut2.slice9.exr")}, {});
    ASSERT_EQ(volume.dims, (Dims{2, 2, 3}));
    std::vector<double> values(12);
    readBlock(volume, {0, 0, 0}, volume.dims, values.data());
    EXPECT_EQ(values, (std::vector<double>{82, 92, 102, 80, 90, 100, 83, 93, 103, 81, 91, 101}));
    const auto refused = [&](const std::string& said, std::vector<std::filesystem::path> files) {
        expectError(ErrorKind::Input, said, [&] { readImageFiles(files, {}); });
    };
    refused("are missing between 8 and 10: 9", {file("cut2.slice10.exr"), file("cut2.slice8.exr")});
    refused("are not slices of one volume", {file("cut2.slice8.exr"), file("cut3.slice9.exr")});
    refused("are not slices of one volume", {file("cut2.slice8.exr"), file("other8.exr")});
    refused("is given more than once", {file("cut2.slice8.exr"), file("cut2.slice8.exr")});
    refused("have the same number, 8", {file("cut2.slice8.exr"), file("cut2.slice08.exr")});
}

/// A TIFF by hand: a page of `width` x 1 bytes for each.
std::string tiff(const std::vector<std::string>& pages) {
    const auto number = [](std::size_t v, int bytes) {
        std::string text;
        for (int i = 0; i < bytes; ++i) text += static_cast<char>(v >> (8 * i) & 255);
        return text;
    };
    std::string bytes = "II*" + std::string(1, '\0'), pending;
    std::size_t link = bytes.size();
    bytes += number(0, 4);
    for (const std::string& page : pages) {
        const std::size_t values = bytes.size();
        bytes += page + std::string(page.size() % 2, '\0');
        bytes.replace(link, 4, number(bytes.size(), 4));
        const auto tag = [&](std::size_t id, std::size_t kind, std::size_t value) {
            return number(id, 2) + number(kind, 2) + number(1, 4) + number(value, 4);
        };
        constexpr std::size_t u16 = 3, u32 = 4;
        const std::string tags = tag(256, u32, page.size()) + tag(257, u32, 1) + tag(258, u16, 8) +
                                 tag(259, u16, 1) + tag(262, u16, 1) + tag(273, u32, values) +
                                 tag(277, u16, 1) + tag(278, u32, 1) + tag(279, u32, page.size());
        bytes += number(9, 2) + tags;
        link = bytes.size();
        bytes += number(0, 4);
    }
    return bytes;
}

TEST_F(ImageStack, PagesOfATiffAreSlices) {
    writeText(dir / "a.tif", tiff({std::string("\x00\x33", 2), "\x66\x99", "\xcc\xff"}));
    const DenseVolume volume = readImagePages(dir / "a.tif", {});
    ASSERT_EQ(volume.dims, (Dims{2, 1, 3}));
    ASSERT_EQ(volume.channels, 1);
    std::vector<double> values(6);
    readBlock(volume, {0, 0, 0}, volume.dims, values.data());
    const std::vector<double> expected{0, 0.4, 0.8, 0.2, 0.6, 1};
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(values[i], expected[i], 1e-7) << i;
    const auto refused = [&](const std::string& said, const std::string& bytes) {
        writeText(dir / "b.tif", bytes);
        expectError(ErrorKind::Input, said, [&] { readImagePages(dir / "b.tif", {}); });
        expectError(ErrorKind::Input, "b.tif", [&] { readImagePages(dir / "b.tif", {}); });
    };
    refused("is one picture, and a volume needs several", tiff({"ab"}));
    refused("page 2 of", tiff({"ab", "abc"}));
    refused("", "II*");
}

}  // namespace
}  // namespace woodcock::test
