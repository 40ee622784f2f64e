// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/block_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "woodcock/base/random.h"

namespace woodcock::test {

using namespace grid;

namespace {

TEST(BlockTable, SparseAndDenseFindWhatWasSet) {
    const Box3i bounds{{-20, -20, -20}, {20, 20, 20}};
    for (bool dense : {true, false}) {
        BlockTable<int> table(bounds, -1, dense);
        std::map<std::array<int, 3>, int> truth;
        RandomStream random(1);
        const auto coordinate = [&] { return static_cast<int>(random.uniform() * 41) - 20; };
        for (int i = 1; i < 500; ++i) {
            const Vec3i b{coordinate(), coordinate(), coordinate()};
            table.at(b) = i, truth[{b.x, b.y, b.z}] = i;
        }
        for (int x = -22; x <= 22; ++x)
            for (int y = -22; y <= 22; ++y)
                for (int z = -22; z <= 22; ++z) {
                    const auto expected = truth.find({x, y, z});
                    ASSERT_EQ(*table.find({x, y, z}).value,
                              expected == truth.end() ? -1 : expected->second);
                }
    }
}

TEST(BlockTable, CubesAreFilledAndSplitAtEveryLevel) {
    BlockTable<int> table({{-1 << 20, -1 << 20, -1 << 20}, {1 << 20, 1 << 20, 1 << 20}}, 0, false);
    table.fill({-512, 512, -1024}, superLog2, 1);
    table.fill({-512, 512, -1008}, regionLog2, 2);  // inside the first
    table.fill({16, -16, 0}, regionLog2, 3);
    table.fill({1 << 19, -1 << 19, 7}, blockLog2, 4);
    table.at({17, -15, 1}) = 5;  // inside the third
    EXPECT_EQ(*table.find({-1, 1023, -513}).value, 1);
    EXPECT_EQ(table.find({-1, 1023, -513}).log2Size, regionLog2);
    EXPECT_EQ(*table.find({-512, 512, -1024}).value, 1);
    EXPECT_EQ(*table.find({-513, 512, -1024}).value, 0);
    EXPECT_EQ(*table.find({-497, 527, -993}).value, 2);
    EXPECT_EQ(*table.find({-497, 527, -992}).value, 1);
    EXPECT_EQ(*table.find({31, -1, 15}).value, 3);
    EXPECT_EQ(*table.find({17, -15, 1}).value, 5);
    EXPECT_EQ(*table.find({17, -15, 2}).value, 3);
    EXPECT_EQ(*table.find({32, -1, 15}).value, 0);
    EXPECT_EQ(*table.find({1 << 19, -1 << 19, 7}).value, 4);
    EXPECT_EQ(*table.find({1 << 19, -1 << 19, 8}).value, 0);
}

TEST(BlockTable, VisitsEveryEntryAtItsPlace) {
    for (bool dense : {true, false}) {
        BlockTable<int> table({{-18, 1000, -3}, {-1, 1018, 3}}, 0, dense);
        table.at({-18, 1001, -3}) = 7, table.at({-1, 1018, 3}) = 8;
        if (!dense) table.fill({-1024, -512, 512}, superLog2, 9);
        int found = 0;
        table.forEach([&](Vec3i b, int log2Size, const int& value) {
            EXPECT_EQ(table.find(b).value, &value);
            EXPECT_EQ(table.find(b).log2Size, log2Size);
            found += value;
        });
        EXPECT_EQ(found, dense ? 15 : 24);
    }
}

TEST(BlockTable, MapKeepsTheShape) {
    BlockTable<int> table({{0, 0, 0}, {0, 0, 0}}, 1, false);
    table.fill({0, 0, 0}, regionLog2, 2);
    table.at({-5, 3, 3}) = 3;
    const BlockTable<double> half = table.map<double>([](int v) { return v / 2.0; });
    EXPECT_EQ(half.outside(), 0.5);
    EXPECT_EQ(*half.find({15, 15, 15}).value, 1);
    EXPECT_EQ(half.find({15, 15, 15}).log2Size, regionLog2);
    EXPECT_EQ(*half.find({-5, 3, 3}).value, 1.5);
    EXPECT_EQ(*half.find({-5, 3, 4}).value, 0.5);
}

}  // namespace
}  // namespace woodcock::test
