// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/load_surfaces.h"

#include <gtest/gtest.h>

#include "woodcock/base/error.h"
#include "woodcock/base/temp_dir.h"

namespace woodcock::test {

using namespace scene;
namespace {

std::vector<Affine3d> read(const std::string& text) {
    const TempDir dir;
    writeText(dir / "places.txt", text);
    return readInstanceFile(dir / "places.txt");
}
/// Without the directory.
std::string mistakeIn(const std::string& text) {
    try {
        read(text);
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Input);
        const std::string message = e.what();
        return message.substr(message.find("places.txt"));
    }
    return "";
}
const std::string expected =
    "expected x y z, x y z scale, x y z scale rx ry rz, or the 12 numbers of a matrix of three "
    "rows";

TEST(InstanceFile, ReadsEachKindOfLine) {
    const auto places = read(
        "# trees\n1 2 3\r\n\n  +1\t2 3 0.5 # small\n1 2 3 2 0 90 0\n"
        "1 0 0 4   0 2 0 5   0 0 1 6");
    ASSERT_EQ(places.size(), 4u);
    EXPECT_EQ(places[0], Affine3d::translate({1, 2, 3}));
    EXPECT_EQ(places[1].point({2, 0, 0}), (Vec3d{2, 2, 3}));
    const Vec3d turned = places[2].point({1, 0, 0});  // a quarter turn about y takes x to -z
    EXPECT_NEAR(turned.x, 1, 1e-15);
    EXPECT_NEAR(turned.z, 1, 1e-15);
    EXPECT_EQ(places[3].point({1, 1, 1}), (Vec3d{5, 7, 7}));
}

TEST(InstanceFile, MistakesNameTheLine) {
    EXPECT_EQ(mistakeIn("1 2 3\n1 2\n"), "places.txt:2: found 2 numbers; " + expected);
    EXPECT_EQ(mistakeIn("1"), "places.txt:1: found 1 number; " + expected);
    EXPECT_EQ(mistakeIn("1 2 3 1 2 3 1 2 3 1 2 3 1"),
              "places.txt:1: found more than 12 numbers; " + expected);
    EXPECT_EQ(mistakeIn("\n\n1 2 x3"),
              "places.txt:3: found 'x3', which is no number that can be used; " + expected);
    EXPECT_EQ(mistakeIn("1 2 nan"),
              "places.txt:1: found 'nan', which is no number that can be used; " + expected);
    EXPECT_EQ(mistakeIn("1 2 1e999"),
              "places.txt:1: found '1e999', which is no number that can be used; " + expected);
    EXPECT_EQ(mistakeIn("1 2 3 0"),
              "places.txt:1: found a transform that is singular: it flattens space (its "
              "determinant is 0)");
    EXPECT_EQ(mistakeIn("# none\n"), "places.txt places no instance; expected lines of " +
                                         expected.substr(std::string("expected ").size()));
}

}  // namespace
}  // namespace woodcock::test
