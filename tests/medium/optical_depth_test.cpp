// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/medium/media.h"
#include "woodcock/medium/optical_depth.h"

namespace woodcock::test {

using namespace proof;

using namespace medium;
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(ExactOpticalDepth, AgreesWithBruteForce) {
    for (const PlainMedium& plain : {greyMedium(), hazyMedium(), chromaticMedium(), tintedGlass()})
        for (int smallestLog2 : {1, 6}) {
            const Medium medium = plain.medium(1, smallestLog2);
            int deep = 0;
            for (const TestRay& ray : testRays(medium, 60, 3))
                for (double t0 : {0.0, 0.3 * ray.tMax}) {
                    const Rgb depth =
                        exactOpticalDepth(medium, ray.origin, ray.direction, t0, ray.tMax);
                    const Vec3d expected =
                        plain.opticalDepth(ray.origin, ray.direction, t0, ray.tMax);
                    for (int c = 0; c < 3; ++c)
                        EXPECT_NEAR(depth[c], expected[c], 1e-6 * (1 + expected[c]));
                    deep += expected.x > 0.5;
                }
            EXPECT_GT(deep, 10);
        }
}

TEST(ExactOpticalDepth, OfALinearRampIsKnown) {
    PlainGrid grid;
    for (int i = 0; i < 4; ++i)
        grid.setLeaf({i * 8, 0, 0}, [](Vec3i v, int) { return static_cast<float>(v.x); });
    const Medium medium = PlainMedium({{.grid = grid}}).medium();
    const Rgb depth = exactOpticalDepth(medium, {0, 3.5, 4}, {1, 0, 0}, 1.25, 30.75);
    EXPECT_FLOAT_EQ(depth[0], static_cast<float>((30.75 * 30.75 - 1.25 * 1.25) / 2));
}

TEST(ExactOpticalDepth, OfAnEndlessChromaticBackgroundIsTheBackground) {
    const Medium medium =
        PlainMedium({{.grid = mixedGrid(1, 3, haze), .scattering = {1, 2, 3}}}).medium();
    const Rgb depth = exactOpticalDepth(medium, {1e4, 0, 0}, {1, 0, 0}, 0, 1e8);
    for (int c = 0; c < 3; ++c)
        EXPECT_FLOAT_EQ(depth[c],
                        1e8f * haze[static_cast<std::size_t>(c)] * static_cast<float>(c + 1));
    const Rgb endless = exactOpticalDepth(medium, {0, 0, 0}, {1, 0, 0}, 0, infinity);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(endless[c], static_cast<float>(infinity));
}

TEST(ExactOpticalDepth, FarOriginsAndExtremeVoxels) {
    for (double voxel : {1e-6, 1.0, 1e6}) {
        PlainGrid grid;
        grid.setTile({0, 0, 0}, 128, {1});
        const PlainMedium plain({{.grid = grid,
                                  .worldFromIndex = Affine3d::scale({voxel, voxel, voxel}),
                                  .scattering = Rgb(static_cast<float>(1 / voxel))}});
        for (double far : {10.0, 1e7}) {
            const Rgb depth = exactOpticalDepth(
                plain.medium(), {-far * voxel, 50 * voxel, 50 * voxel}, {1, 0, 0}, 0, infinity);
            EXPECT_NEAR(depth[0], 128, 1e-4);
        }
    }
}

TEST(FindTransmittance, FindsWhereTheMeanOverChannelsFallsSoFar) {
    const auto meanOf = [](Rgb depth) {
        return (std::exp(-double{depth[0]}) + std::exp(-double{depth[1]}) +
                std::exp(-double{depth[2]})) /
               3;
    };
    int found = 0, missed = 0;
    for (const PlainMedium& plain :
         {greyMedium(), hazyMedium(), chromaticMedium(), tintedGlass()}) {
        const Medium medium = plain.medium();
        for (const TestRay& ray : testRays(medium, 40, 5)) {
            DepthAlong along{.medium = medium, .origin = ray.origin, .direction = ray.direction};
            for (const double target : {0.99, 0.5}) {
                const auto depthTo = [&](double t) {
                    return exactOpticalDepth(medium, ray.origin, ray.direction, 0, t);
                };
                if (findTransmittance(along, ray.tMax, target)) {
                    EXPECT_NEAR(meanOf(depthTo(along.t)), target, 3e-6);
                    EXPECT_LE(along.t, ray.tMax);
                    ++found;
                } else {
                    EXPECT_GT(meanOf(depthTo(ray.tMax)), target * (1 - 1e-6));
                    ++missed;
                }
            }
        }
    }
    EXPECT_GT(found, 50);
    EXPECT_GT(missed, 5);
}

/// Deeper than a double's exponential reaches, and without an end.
TEST(FindTransmittance, OfMediaThatAreDeepOrEndless) {
    const auto box = [](float sigma, double side) {
        MediumPart::Description part;
        part.box = {{0, -1, -1}, {side, 1, 1}};
        part.absorption = Rgb(sigma), part.scattering = Rgb(0.0f);
        Medium medium;
        medium.parts.emplace_back(std::move(part));
        return medium;
    };
    for (const float sigma : {1e-6f, 1.0f, 1e6f}) {
        const Medium medium = box(sigma, 1e9);
        DepthAlong along{.medium = medium, .origin = {-3, 0, 0}, .direction = {1, 0, 0}};
        ASSERT_TRUE(findTransmittance(along, infinity, 0.5)) << sigma;
        EXPECT_NEAR(along.t, 3 + std::log(2.0) / sigma, 1e-6 * along.t) << sigma;
    }
    const Medium thin = box(1e-12f, 1);
    DepthAlong along{.medium = thin, .origin = {-3, 0, 0}, .direction = {1, 0, 0}};
    EXPECT_FALSE(findTransmittance(along, infinity, 0.5));
    DepthAlong beside{.medium = thin, .origin = {-3, 5, 0}, .direction = {1, 0, 0}};
    EXPECT_FALSE(findTransmittance(beside, infinity, 0.99));
}

}  // namespace
}  // namespace woodcock::test
