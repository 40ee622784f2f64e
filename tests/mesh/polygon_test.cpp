// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "woodcock/mesh/polygon.h"

namespace woodcock::test {

using namespace mesh;

namespace {

double areaOfTriangles(const std::vector<Vec3d>& corners) {
    double area = 0;
    for (const auto& [a, b, c] : triangulate(corners))
        area += length(cross(corners[b] - corners[a], corners[c] - corners[a])) / 2;
    return area;
}

/// Triangles that overlap or lie outside would have a larger area.
TEST(Polygon, ReentrantCornersAreKeptOut) {
    std::vector<Vec3d> arrow{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}};
    for (std::size_t turn = 0; turn < arrow.size(); ++turn) {
        EXPECT_DOUBLE_EQ(areaOfTriangles(arrow), 16 - 6);
        std::rotate(arrow.begin(), arrow.begin() + 1, arrow.end());
    }
    const std::vector<Vec3d> mirrored(arrow.rbegin(), arrow.rend());
    EXPECT_DOUBLE_EQ(areaOfTriangles(mirrored), 16 - 6);
}

TEST(Polygon, ACombIsCoveredOnce) {
    constexpr int teeth = 40;
    std::vector<Vec3d> comb{{0, 0, 0}, {0, 0, 2.0 * teeth}};
    double area = 0;
    for (int i = teeth; i-- > 0; area += 1 * 1 + 1 * 3) {
        comb.push_back({0, 3, 2.0 * i + 2});
        comb.push_back({0, 3, 2.0 * i + 1});
        comb.push_back({0, 1, 2.0 * i + 1});
        comb.push_back({0, 1, 2.0 * i});
    }
    EXPECT_DOUBLE_EQ(areaOfTriangles(comb), area);
    EXPECT_EQ(triangulate(comb).size(), comb.size() - 2);
}

TEST(Polygon, LargeAndFlatOnesEnd) {
    std::vector<Vec3d> circle;
    for (int i = 0; i < 5000; ++i)
        circle.push_back({std::cos(2 * pi * i / 5000), std::sin(2 * pi * i / 5000), 0});
    EXPECT_NEAR(areaOfTriangles(circle), pi, 1e-5);
    EXPECT_EQ(triangulate(std::vector<Vec3d>(7)).size(), 5u);
}

}  // namespace
}  // namespace woodcock::test
