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

}  // namespace
}  // namespace woodcock::test
