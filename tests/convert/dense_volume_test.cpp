// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/dense_volume.h"

#include <gtest/gtest.h>

#include "tests/support/expect_error.h"

namespace woodcock::test {

using namespace convert;

namespace {

/// 2 x 3 x 4 floats 0, 1, 2, ... with x the fastest, voxels of 1 x 2 x 3 from (10, 20, 30).
DenseVolume counting() {
    DenseVolume volume;
    volume.dims = {2, 3, 4};
    volume.setStridesXFirst();
    auto values = std::make_shared<std::vector<float>>(24);
    for (std::size_t i = 0; i < 24; ++i) (*values)[i] = static_cast<float>(i);
    volume.samples = reinterpret_cast<const char*>(values->data());
    volume.owner = values;
    volume.worldFromIndex = Affine3d::translate({10, 20, 30}) * Affine3d::scale({1, 2, 3});
    volume.placed = true;
    return volume;
}

double valueAt(const DenseVolume& volume, std::int64_t i, std::int64_t j, std::int64_t k) {
    double value = -1;
    readBlock(volume, {i, j, k}, {1, 1, 1}, &value);
    return value;
}

TEST(DenseVolume, ReadsBlocksInTheOrderOfLeaves) {
    std::vector<float> block(2 * 2 * 3);
    readBlock(counting(), {0, 1, 1}, {2, 2, 3}, block.data());
    EXPECT_EQ(block, (std::vector<float>{8, 14, 20, 10, 16, 22, 9, 15, 21, 11, 17, 23}));
}

TEST(DenseVolume, TurnsAsARigidBody) {
    const DenseVolume original = counting();
    for (const char* text : {"xyz", "xzy", "zxy", "x,-z,y", "-x-y-z", "y,-x,z"}) {
        const AxisOrder axes = parseAxisOrder(text);
        DenseVolume turned = original;
        applyAxisOrder(turned, axes);
        for (std::int64_t i = 0; i < 2; ++i)
            for (std::int64_t j = 0; j < 3; ++j)
                for (std::int64_t k = 0; k < 4; ++k) {
                    const Vec3d from =
                        original.worldFromIndex.point({double(i), double(j), double(k)});
                    Vec3d to;
                    for (std::size_t a = 0; a < 3; ++a)
                        to[int(a)] = (axes.reversed[a] ? -1 : 1) * from[axes.from[a]];
                    const Vec3d at = turned.worldFromIndex.inverse().point(to);
                    EXPECT_EQ(
                        valueAt(turned, std::lround(at.x), std::lround(at.y), std::lround(at.z)),
                        valueAt(original, i, j, k))
                        << text;
                }
        for (int a = 0; a < 3; ++a)
            EXPECT_GT(turned.worldFromIndex.column[std::size_t(a)][a], 0) << text;
    }
}

TEST(DenseVolume, StraightensWithoutMoving) {
    DenseVolume mirrored = counting();
    mirrored.worldFromIndex = Affine3d::translate({5, 6, 7}) * Affine3d::scale({-1, -2, 3});
    DenseVolume straight = mirrored;
    straighten(straight);
    EXPECT_EQ(straight.worldFromIndex, Affine3d::translate({4, 2, 7}) * Affine3d::scale({1, 2, 3}));
    EXPECT_EQ(valueAt(straight, 0, 0, 0), valueAt(mirrored, 1, 2, 0));
    // A rotation is no matter of names.
    DenseVolume rotated = counting();
    rotated.worldFromIndex = Affine3d::rotate(2, 30);
    DenseVolume same = rotated;
    straighten(same);
    EXPECT_EQ(same.worldFromIndex, rotated.worldFromIndex);
}

TEST(DenseVolume, RefusesWrongOrdersOfAxes) {
    for (const char* text : {"", "xy", "xxz", "xyzx", "abc", "x,-z,", "--xyz", "xyz-"})
        expectError(ErrorKind::Usage, "order of axes", [&] { parseAxisOrder(text); });
}

TEST(DenseVolume, CountsBytesWithinBounds) {
    EXPECT_EQ(denseBytes({2, 3, 4}, 3, SampleType::F64), 2u * 3 * 4 * 3 * 8);
    EXPECT_FALSE(denseBytes({0, 3, 4}, 1, SampleType::U8));
    EXPECT_FALSE(denseBytes({2, -3, 4}, 1, SampleType::U8));
    EXPECT_FALSE(denseBytes({2, 3, 4}, 0, SampleType::U8));
    EXPECT_FALSE(denseBytes({1 << 30, 1 << 30, 1 << 30}, 1, SampleType::U8));
    EXPECT_FALSE(denseBytes({mostVoxelsOfSide + 1, 1, 1}, 1, SampleType::U8));
}

}  // namespace
}  // namespace woodcock::test
