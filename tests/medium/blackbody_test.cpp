// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/blackbody.h"

#include <gtest/gtest.h>

#include <array>

#include "woodcock/proof/support/plain_grid.h"

namespace woodcock::test {

using namespace grid;
using namespace medium;
using namespace proof;

namespace {

double luminance(Rgb c) { return 0.2126390059 * c[0] + 0.7151686788 * c[1] + 0.0721923154 * c[2]; }

/// The CIE's chromaticity of a colour of linear Rec.709.
std::array<double, 2> chromaticity(Rgb c) {
    const double x = 0.4123908 * c[0] + 0.3575843 * c[1] + 0.1804808 * c[2];
    const double y = 0.2126390 * c[0] + 0.7151687 * c[1] + 0.0721923 * c[2];
    const double z = 0.0193308 * c[0] + 0.1191948 * c[1] + 0.9505322 * c[2];
    return {x / (x + y + z), y / (x + y + z)};
}

/// Published coordinates of the Planckian locus (2 degree observer of 1931); 2856 K is the CIE's
/// illuminant A.
TEST(Blackbody, LiesOnThePlanckianLocus) {
    struct Row {
        double kelvin, x, y;
    };
    for (const auto& [kelvin, x, y] : {Row{1000, 0.6528, 0.3444},
                                       {2000, 0.5267, 0.4133},
                                       {2856, 0.4476, 0.4074},
                                       {6500, 0.3135, 0.3237},
                                       {10000, 0.2807, 0.2884}}) {
        const auto [u, v] = chromaticity(blackbodyColour(kelvin));
        EXPECT_NEAR(u, x, 2e-4) << kelvin;
        EXPECT_NEAR(v, y, 2e-4) << kelvin;
    }
}

/// Cycles' fit, which is off by as much.
TEST(Blackbody, IsNearCycles) {
    struct Row {
        double kelvin;
        Rgb colour;
        double largest;
    };
    for (const auto& [kelvin, colour, largest] : {Row{1500, {3.26431f, 0.43405f, -0.06424f}, 0.02},
                                                  {3000, {1.77084f, 0.84428f, 0.27222f}, 0.02},
                                                  {6500, {1.04255f, 0.98405f, 1.03527f}, 0.02}})
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(blackbodyColour(kelvin)[c], colour[c], largest) << kelvin << ", " << c;
}

TEST(Blackbody, HasLuminanceOneAndRadiatesByStefanAndBoltzmann) {
    for (const double kelvin : {300.0, 777.0, 1234.5, 5000.0, 1e5, 1e9}) {
        EXPECT_NEAR(luminance(blackbodyColour(kelvin)), 1, 2e-6) << kelvin;
        const double watts = 1.80493627e-14 * kelvin * kelvin * kelvin * kelvin;
        EXPECT_NEAR(luminance(blackbodyRadiance(kelvin)) / watts, 1, 2e-6) << kelvin;
    }
    for (const double kelvin : {0.0, -1.0}) EXPECT_EQ(blackbodyRadiance(kelvin), Rgb(0));
}

TEST(BlackbodySource, GlowsVoxelByVoxel) {
    PlainGrid grid;
    grid.setLeaf({0, 0, 0}, [](Vec3i v, int) { return v.x == 0 ? 0.0f : static_cast<float>(v.x); });
    grid.setTile({8, 0, 0}, 8, {2, 0, 0});
    const Field field = buildField(blackbodySource(grid.source(), 500, 300), Storage::Float);
    for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(field.voxel({0, 3, 3}, c), 0);  // the background's value
        EXPECT_EQ(field.voxel({3, 1, 2}, c), blackbodyRadiance(1800)[c]);
        EXPECT_EQ(field.voxel({11, 1, 2}, c), blackbodyRadiance(1300)[c]);
        EXPECT_EQ(field.voxel({100, 1, 2}, c), 0);
    }
}

}  // namespace
}  // namespace woodcock::test
