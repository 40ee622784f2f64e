// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/features.h"

#include <gtest/gtest.h>

#include "woodcock/medium/medium.h"
#include "woodcock/proof/support/plain_grid.h"

namespace woodcock::test {

using namespace grid;
using namespace medium;
using namespace proof;

namespace {

/// Density falls evenly with the distance from the middle, in voxels of 0.1 x 0.1 x 0.3.
MediumPart cone() {
    PlainGrid grid;
    for (int z = -16; z < 16; z += 8)
        for (int y = -16; y < 16; y += 8)
            for (int x = -16; x < 16; x += 8)
                grid.setLeaf({x, y, z}, [](Vec3i v, int) {
                    return 30 - static_cast<float>(length(v.as<double>()));
                });
    MediumPart::Description d;
    d.field = std::make_shared<const Field>(grid.field());
    d.worldFromIndex = Affine3d::scale({0.1, 0.1, 0.3});
    return MediumPart(d);
}

MediumPart box(Rgb absorption, Rgb scattering) {
    MediumPart::Description d;
    d.box = {{-1, -1, -1}, {1, 1, 1}};
    d.absorption = absorption, d.scattering = scattering;
    return MediumPart(d);
}

TEST(MediumFeatures, NormalIsDownTheGradientInWorldSpace) {
    const Medium medium{{cone()}};
    for (const Vec3d index : {Vec3d{7.3, 2.1, -4.4}, {-6.2, 8.5, 1.5}, {0.5, -0.5, 9.5}}) {
        const Vec3d expected = normalize(Vec3d{index.x / 0.1, index.y / 0.1, index.z / 0.3});
        const Vec3d n = densityNormal(medium, index * Vec3d{0.1, 0.1, 0.3});
        EXPECT_NEAR(length(n), 1, 1e-12);
        // A voxel to either side of a cone 9 voxels away: the curve bends by about (1 / 9)^2 / 2.
        EXPECT_GT(dot(n, expected), 1 - 0.01);
    }
}

TEST(MediumFeatures, EvenMatterHasNoNormal) {
    const Medium medium{{box(Rgb(0.0f), Rgb(1.0f))}};
    EXPECT_EQ(densityNormal(medium, {0.99, 0, 0}), (Vec3d{}));
    EXPECT_EQ(densityNormal({}, {}), (Vec3d{}));
}

TEST(MediumFeatures, AlbedoIsOfTheSum) {
    const Medium medium{{box(Rgb(0.5f, 1, 0), Rgb(0.5f, 0, 0)), box(Rgb(0.0f), Rgb(1, 1, 0))}};
    EXPECT_EQ(scatteringAlbedo(medium, {}), Rgb(0.75f, 0.5f, 0));
    EXPECT_EQ(scatteringAlbedo(medium, {2, 0, 0}), Rgb(0.0f));
}

}  // namespace
}  // namespace woodcock::test
