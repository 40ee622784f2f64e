// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/write_exr.h"

#include <gtest/gtest.h>

#include "tests/support/expect_error.h"
#include "tests/support/paths.h"
#include "woodcock/proof/support/read_back.h"

namespace woodcock::test {

using namespace image;
using namespace proof;

namespace {

TEST(AnnotateExr, KeepsPixelsAndAddsAttributes) {
    const TempDir dir;
    const std::vector<float> values{0.1f, -2, 3e5f, 0, 1e-9f, 6, 7, 8, 9, 10, 11, 12};
    writeFloats(dir / "in.exr", 2, 2, 3, values);
    annotateExr(dir / "in.exr", dir / "out.exr", {{"woodcock/note", "hello"}, {"woodcock/n", 3}});
    const ReadBack image = readBack(dir / "out.exr");
    EXPECT_EQ(image.values, values);
    EXPECT_EQ(image.channels, readBack(dir / "in.exr").channels);
    EXPECT_EQ(image.fullWidth, 2);
    EXPECT_EQ(image.attributes.at("woodcock/note"), "hello");
    EXPECT_EQ(image.attributes.at("woodcock/n"), "3");
}

TEST(AnnotateExr, RefusesWhatIsNoImage) {
    const TempDir dir;
    writeText(dir / "in.exr", "no image");
    for (const char* name : {"in.exr", "none.exr"})
        expectError(ErrorKind::Input, name, [&] { annotateExr(dir / name, dir / "out.exr", {}); });
    EXPECT_FALSE(std::filesystem::exists(dir / "out.exr"));
}

}  // namespace
}  // namespace woodcock::test
