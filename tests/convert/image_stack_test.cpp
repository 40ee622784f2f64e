// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/expect_error.h"
#include "tests/support/read_back.h"
#include "tests/support/temp_dir.h"
#include "woodcock/convert/dense_formats.h"

namespace woodcock::test {
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
    writeText(dir / "s.07.exr", "no picture");
    refused("s.07.exr");
}

}  // namespace
}  // namespace woodcock::test
