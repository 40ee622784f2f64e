// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/depth_grid.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "tests/medium/media.h"
#include "woodcock/base/random.h"
#include "woodcock/medium/optical_depth.h"
#include "woodcock/medium/tracking.h"

namespace woodcock::test {

using namespace proof;

using namespace medium;
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t plenty = 1 << 26;
const Vec3d towards = normalize(Vec3d{0.3, 0.8, -0.5});

std::vector<Vec3d> pointsIn(const Medium& medium, int count) {
    const Box3d box = medium.worldBounds();
    RandomStream random(11);
    std::vector<Vec3d> points;
    for (int i = 0; i < count; ++i)
        points.push_back(box.lower +
                         box.size() * Vec3d{random.uniform(), random.uniform(), random.uniform()});
    return points;
}

TEST(DepthGrid, OfABoxIsExactInside) {
    const Medium fog =
        PlainMedium({{.grid = {}, .box = {{-1, -1, -1}, {1, 1, 1}}, .scattering = Rgb(0.7f)}})
            .medium();
    const auto grid = DepthGrid::make(fog, {0, 1, 0}, plenty);
    for (const Vec3d p : {Vec3d{0.1, 0.2, 0.3}, {-0.7, -0.8, 0.5}, {0.4, 0.9, 0.61}}) {
        const auto d = grid->at<1>(p)[0];
        EXPECT_NEAR(d.depth, 0.7 * (1 - p.y), 1e-6);
        EXPECT_LE(d.least, d.depth);
        EXPECT_GE(d.most, d.depth);
    }
    EXPECT_EQ(grid->at<1>({0, 1.2, 0})[0].depth, 0);           // beyond the medium
    EXPECT_NEAR(grid->at<1>({0, -5, 0})[0].depth, 1.4, 1e-6);  // before it
}

/// Where density rises and falls evenly between nodes, the depth is made of parabolas. Chords
/// between exact nodes miss them by at most h^2 / 8 times their second derivative.
TEST(DepthGrid, IsExactAtItsNodes) {
    PlainGrid grid;
    for (int x = 0; x < 4; ++x)
        for (int y = 0; y < 4; ++y)
            for (int z = 0; z < 4; ++z)
                grid.setLeaf({x * 8, y * 8, z * 8}, [](Vec3i v, int) {
                    return static_cast<float>(v.x <= 13 ? v.x + 1 : std::max(0, 27 - v.x));
                });
    const float sigma = 0.01f;
    const Medium medium = PlainMedium({{.grid = grid, .scattering = Rgb(sigma)}}).medium();
    const auto depths = DepthGrid::make(medium, {1, 0, 0}, plenty);
    ASSERT_EQ(depths->spacing(), 1.4);  // from -1 on; density has its kinks at 13 and 27
    const double most = depths->spacing() * depths->spacing() / 8 * double{sigma};
    double largest = 0;
    for (double x = -0.9; x < 31; x += 0.37) {
        const Vec3d p{x, 13.4, 16.1};
        const double missed =
            std::abs(double{depths->at<1>(p)[0].depth} -
                     double{exactOpticalDepth(medium, p, {1, 0, 0}, 0, infinity)[0]});
        EXPECT_LE(missed, most + 1e-5) << x;
        largest = std::max(largest, missed);
    }
    EXPECT_GT(largest, 0.8 * most);
}

TEST(DepthGrid, ColoursThatDifferHaveDepthsOfTheirOwn) {
    const Medium grey =
        PlainMedium({{.grid = mixedGrid(1), .scattering = {0.1f, 0.2f, 0.4f}}}).medium();
    const auto one = DepthGrid::make(grey, towards, plenty);
    for (const Vec3d p : pointsIn(grey, 30)) {
        const auto d = one->at<3>(p);
        EXPECT_FLOAT_EQ(d[0].depth, d[2].depth / 4);
        EXPECT_FLOAT_EQ(d[1].least, d[2].least / 2);
    }
    const Medium two = PlainMedium({{.grid = mixedGrid(1), .scattering = {0.1f, 0.2f, 0.4f}},
                                    {.grid = mixedGrid(3), .scattering = {0.4f, 0.2f, 0.1f}}})
                           .medium();
    const auto three = DepthGrid::make(two, towards, plenty);
    int differ = 0;
    for (const Vec3d p : pointsIn(two, 200)) {
        const auto d = three->at<3>(p);
        for (int c = 0; c < 3; ++c)
            EXPECT_GE(d[static_cast<std::size_t>(c)].most, d[static_cast<std::size_t>(c)].least);
        differ += std::abs(d[0].depth * 4 - d[2].depth) > 0.01f;
    }
    EXPECT_GT(differ, 20);
}

TEST(DepthGrid, IsTheSameForAnyNumberOfReaders) {
    const Medium medium = greyMedium().medium();
    const std::vector<Vec3d> points = pointsIn(medium, 2000);
    const auto alone = DepthGrid::make(medium, towards, plenty);
    const auto shared = DepthGrid::make(medium, towards, plenty);
    std::vector<float> depths(points.size());
    tbb::parallel_for(std::size_t{0}, points.size(),
                      [&](std::size_t i) { depths[i] = shared->at<1>(points[i])[0].depth; });
    for (std::size_t i = points.size(); i-- > 0;)
        EXPECT_EQ(alone->at<1>(points[i])[0].depth, depths[i]);
    EXPECT_EQ(alone->bytesMade(), shared->bytesMade());
}

/// Where memory is scarce it is coarser; columns that nobody reads take none.
TEST(DepthGrid, KeepsToItsMemory) {
    const Medium medium = greyMedium().medium();
    const auto fine = DepthGrid::make(medium, towards, plenty);
    const auto untouched = DepthGrid::make(medium, towards, plenty);
    const std::vector<Vec3d> points = pointsIn(medium, 5000);
    for (const Vec3d p : points) fine->at<1>(p);
    const std::size_t most = fine->bytesMade() / 3;
    const auto coarse = DepthGrid::make(medium, towards, most);
    for (const Vec3d p : points) coarse->at<1>(p);
    EXPECT_GT(coarse->spacing(), fine->spacing());
    EXPECT_LE(coarse->bytesMade(), most);
    EXPECT_EQ(untouched->bytesMade(), 0u);
    // What all columns would take is known before; the points are in most of them.
    EXPECT_EQ(untouched->bytesOfAll(), fine->bytesOfAll());
    EXPECT_LE(fine->bytesMade(), fine->bytesOfAll());
    EXPECT_GT(2 * fine->bytesMade(), fine->bytesOfAll());
    EXPECT_LE(coarse->bytesOfAll(), most);
}

/// Nor for those that memory cannot show: a slab of voxels a million times as wide as high.
TEST(DepthGrid, IsNotForMediaWithoutEnd) {
    const auto makes = [](const Medium& medium) {
        return DepthGrid::make(medium, towards, plenty) != nullptr;
    };
    EXPECT_TRUE(makes(greyMedium().medium()));
    EXPECT_TRUE(makes(tintedGlass().medium()));
    EXPECT_FALSE(makes(hazyMedium().medium()));
    EXPECT_FALSE(makes(Medium{}));
    EXPECT_FALSE(makes(PlainMedium({{.grid = {}, .box = {{-1, 0, -1}, {1, 0, 1}}}}).medium()));
    EXPECT_FALSE(makes(
        PlainMedium({{.grid = mixedGrid(1), .worldFromIndex = Affine3d::scale({1e6, 1, 1e6})}})
            .medium()));
    EXPECT_FALSE(
        makes(PlainMedium({{.grid = {}, .box = {{-1e6, -1, -1e6}, {1e6, 1, 1e6}}}}).medium()));
}

/// Where light has parallel rays, the depth falls by sigma for each unit towards it. To a lamp it
/// is sigma times the way that lies in the box: from a cube's middle axis, (z + 1) / cosine.
TEST(DepthGrid, OfALampAboveABoxIsNearlyExact) {
    const Medium fog =
        PlainMedium({{.grid = {}, .box = {{-1, -1, -1}, {1, 1, 1}}, .scattering = Rgb(0.7f)}})
            .medium();
    const Vec3d lamp{0.2, 3, -0.1};
    const auto grid = DepthGrid::makeForLamp(fog, lamp, 0, plenty);
    ASSERT_TRUE(grid);
    for (const Vec3d p : {Vec3d{0.1, 0.2, 0.3}, {-0.7, -0.8, 0.5}, {0.4, 0.9, 0.61}}) {
        const auto d = grid->at<1>(p)[0];
        const double exact = 0.7 * (1 - p.y) * length(lamp - p) / (lamp.y - p.y);
        EXPECT_NEAR(d.depth, exact, 1e-3 * exact);
        EXPECT_LE(d.least, d.depth);
        EXPECT_GE(d.most, d.depth);
    }
}

/// A lamp's grid misses the depths to the lamp by no more than a sun's those to the sun, and by
/// less than a sun's in the same direction does.
TEST(DepthGrid, OfALampIsAsNearToTheTruthAsOfASun) {
    const Medium medium = greyMedium().medium();
    const Box3d box = medium.worldBounds();
    const std::vector<Vec3d> points = pointsIn(medium, 500);
    const auto missedBy = [&](const DepthGrid& grid, auto&& towardsLight) {
        double missed = 0;
        for (const Vec3d p : points)
            missed +=
                std::abs(double{grid.at<1>(p)[0].depth} -
                         double{exactOpticalDepth(medium, p, towardsLight(p), 0, infinity)[0]});
        return missed;
    };
    for (const Vec3d side : {Vec3d{1, 0.3, 0.2}, {-0.2, 1.4, -0.9}, {0.1, -0.2, -3}}) {
        const Vec3d lamp = box.centre() + box.size() * side, sun = normalize(lamp - box.centre());
        const auto ofLamp = DepthGrid::makeForLamp(medium, lamp, 0, plenty);
        const auto ofSun = DepthGrid::make(medium, sun, plenty);
        ASSERT_TRUE(ofLamp);
        const auto toLamp = [&](Vec3d p) { return normalize(lamp - p); };
        const double missed = missedBy(*ofLamp, toLamp);
        EXPECT_LT(missed, 1.3 * missedBy(*ofSun, [&](Vec3d) { return sun; }));
        EXPECT_LT(missed, 0.8 * missedBy(*ofSun, toLamp));
    }
}

/// The least and the most are true of most rays to the rim of a wide lamp. A grid that takes it for
/// a small one is wrong of many times as many.
TEST(DepthGrid, OfAWideLampIsLessSure) {
    const Medium medium = greyMedium().medium();
    const Box3d box = medium.worldBounds();
    const double size = length(box.size()), radius = 0.4 * size;
    const Vec3d lamp = box.centre() + Vec3d{0, 1.2 * size, 0};
    const auto holds = [&](const DepthGrid& grid) {
        RandomStream random(5);
        int held = 0;
        for (const Vec3d p : pointsIn(medium, 1000)) {
            const double angle = 2 * pi * random.uniform();
            const Vec3d rim = lamp + Vec3d{std::cos(angle), 0, std::sin(angle)} * radius;
            const float exact = exactOpticalDepth(medium, p, normalize(rim - p), 0, infinity)[0];
            const DepthGrid::Depth d = grid.at<1>(p)[0];
            EXPECT_GE(d.least, 0);
            held += d.least <= exact && exact <= d.most;
        }
        return held;
    };
    const int wide = holds(*DepthGrid::makeForLamp(medium, lamp, radius, plenty));
    const int small = holds(*DepthGrid::makeForLamp(medium, lamp, 0, plenty));
    EXPECT_LT(4 * (1000 - wide), 1000 - small);
}

/// Readers that interpolate by themselves find what at() does.
TEST(DepthGrid, TellsWhereItsNodesAre) {
    const Medium medium = greyMedium().medium();
    const Box3d box = medium.worldBounds();
    for (const bool ofLamp : {false, true}) {
        const auto grid =
            ofLamp ? DepthGrid::makeForLamp(medium, box.centre() + box.size() * Vec3d{0.4, 1, -0.7},
                                            0, plenty)
                   : DepthGrid::make(medium, towards, plenty);
        const Affine3d map = grid->latticeFromWorld();
        const auto perspective = grid->perspective();
        const Vec3i cells = grid->cells();
        const auto strides = grid->strides();
        for (const Vec3d p : pointsIn(medium, 200)) {
            Vec3d x = map.point(p);
            const double distance = perspective[0] + perspective[1] * x.z;
            EXPECT_TRUE(ofLamp || distance == 1);
            x.x /= distance, x.y /= distance;
            Vec3i cell;
            for (int i = 0; i < 3; ++i) {
                ASSERT_GT(x[i], -1e-6);
                ASSERT_LT(x[i], cells[i] + 1e-6);
                cell[i] = std::clamp(static_cast<int>(x[i]), 0, cells[i] - 1);
            }
            const float* node = grid->nodes(cell.x, cell.y, cell.z);
            double depth = 0;
            for (std::size_t corner = 0; corner < 8; ++corner) {
                double weight = 1;
                std::size_t at = 0;
                for (std::size_t i = 0; i < 3; ++i) {
                    const int axis = static_cast<int>(i);
                    const double within = x[axis] - cell[axis];
                    weight *= corner >> i & 1 ? within : 1 - within;
                    at += (corner >> i & 1) * strides[i];
                }
                depth += weight * double{node[at]};
            }
            EXPECT_NEAR(double{grid->at<1>(p)[0].depth}, depth, 1e-4 * (1 + depth));
        }
    }
}

/// Lamps that are in the medium or near it have none. What rays to a wide lamp run through differs
/// from the grid's lines by more than a node.
TEST(DepthGrid, IsForLampsFromAfar) {
    const Medium medium = greyMedium().medium();
    const Box3d box = medium.worldBounds();
    const double size = length(box.size());
    const auto makes = [&](Vec3d lamp, double radius) {
        return DepthGrid::makeForLamp(medium, lamp, radius, plenty) != nullptr;
    };
    const auto above = [&](double distance) {
        return Vec3d{box.centre().x, box.upper.y + distance, box.centre().z};
    };
    EXPECT_FALSE(makes(box.centre(), 0));
    EXPECT_FALSE(makes(above(0.09 * size), 0));
    EXPECT_TRUE(makes(above(0.11 * size), 0));
    EXPECT_FALSE(makes(above(size), 0.95 * size));
    EXPECT_TRUE(makes(above(size), 0.85 * size));
    EXPECT_EQ(DepthGrid::makeForLamp(medium, above(size), 0, plenty)->blur(), 1);
    EXPECT_GT(DepthGrid::makeForLamp(medium, above(size), 0.5 * size, plenty)->blur(), 2);
    EXPECT_FALSE(DepthGrid::makeForLamp(hazyMedium().medium(), above(size), 0, plenty));
}

TEST(ExactTransmittance, AgreesWithBruteForce) {
    const PlainMedium plain = greyMedium();
    const Medium medium = plain.medium();
    std::uint64_t segments = 0;
    for (const Vec3d p : pointsIn(medium, 100)) {
        TrackingCounters counters;
        const Vec3d expected = plain.transmittance(p, towards, 1000);
        EXPECT_NEAR(exactTransmittance<1>(medium, p, towards, counters)[0], expected.x, 1e-6);
        const Rgb all = exactTransmittance<3>(medium, p, towards, counters);
        EXPECT_NEAR(all[2], expected.z, 1e-6);
        segments += counters.segments;
    }
    EXPECT_GT(segments, 1000u);
}

}  // namespace
}  // namespace woodcock::test
