// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/radiance_lattice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/medium/media.h"

namespace woodcock::test {

using namespace proof;

using namespace render;
namespace {

constexpr double side = 8;

medium::Medium cube(Rgb scattering, Rgb absorption) {
    return PlainMedium({{.grid = {},
                         .box = {{0, 0, 0}, {side, side, side}},
                         .absorption = absorption,
                         .scattering = scattering}})
        .medium();
}

const RadianceLattice::Light sky{.environment = {1, 1, 1}, .sun = {}};

const RadianceLattice::Channel& at(const RadianceLattice& lattice, Vec3d world, int channel) {
    const Vec3i cell = floorToInt(lattice.latticeFromWorld().point(world));
    const Vec3i n = lattice.cells();
    return lattice.content()[(cell.z * n.y + cell.y) * n.x + cell.x].channels[channel];
}

/// Calls see(index, cell) for all.
template <class F>
void forAll(const RadianceLattice& lattice, F&& see) {
    const Vec3i n = lattice.cells();
    for (int i = 0; i < n.x * n.y * n.z; ++i) see(i, lattice.content()[i]);
}

/// Far from the other faces phi falls as exp(-x sqrt(3 sigma_a sigma_tr)): roughly so, in cells as
/// wide as 1.3 free paths.
TEST(RadianceLattice, FallsByTheDiffusionLength) {
    const auto lattice = RadianceLattice::make(cube({5, 5, 2}, {0.3f, 0.3f, 1}), sky);
    ASSERT_TRUE(lattice);
    for (const int channel : {0, 2}) {
        const double absorption = channel == 0 ? 0.3 : 1, transport = channel == 0 ? 5.3 : 3;
        const double from = 1.5, to = 3;
        const auto& first = at(*lattice, {from, side / 2, side / 2}, channel);
        const auto& last = at(*lattice, {to, side / 2, side / 2}, channel);
        const double rate = std::log(first.phi / last.phi) / (to - from);
        EXPECT_NEAR(rate, std::sqrt(3 * absorption * transport),
                    0.2 * std::sqrt(3 * absorption * transport));
        EXPECT_LT(first.slope[0], 0);
        EXPECT_NEAR(first.slope[1], 0, 1e-3);
        EXPECT_LT(first.ahead[0], 0);  // more light comes from low x
        EXPECT_NEAR(first.ahead[1], 0, 1e-3);
    }
}

/// Nothing is lost, so the radiance is the same everywhere.
TEST(RadianceLattice, IsEvenInAFurnace) {
    const Rgb around{0.5f, 1, 3};
    for (const float scattering : {0.01f, 0.5f, 20.0f}) {
        const auto lattice = RadianceLattice::make(
            cube({scattering, 2 * scattering, scattering}, {}), {.environment = around, .sun = {}});
        ASSERT_TRUE(lattice);
        forAll(*lattice, [&](int i, const RadianceLattice::Cell& cell) {
            for (int c = 0; c < 3; ++c) {
                ASSERT_NEAR(cell.channels[c].phi, around[c], 1e-4) << i;
                for (const float ahead : cell.channels[c].ahead) ASSERT_NEAR(ahead, 0, 1e-4) << i;
            }
        });
    }
}

/// Where next to nothing scatters, radiance is that around times exp(-sigma_a s), along the way s
/// from the cube's surface. Means over directions by midpoints; 24 ordinates know them to 5 %.
TEST(RadianceLattice, IsThatOfAnAbsorber) {
    const double absorption = 0.15;
    const auto lattice =
        RadianceLattice::make(cube(Rgb(1e-6f), Rgb(static_cast<float>(absorption))), sky);
    ASSERT_TRUE(lattice);
    const double h = 1 / length(lattice->latticeFromWorld().column[0]);
    for (const double x : {0.5 * h, 1.5 * h, 2.0, side / 2, side - 1}) {
        double phi = 0, ahead = 0;
        constexpr int rows = 200, columns = 400;
        for (int i = 0; i < rows; ++i)
            for (int k = 0; k < columns; ++k) {
                const double z = 2 * (i + 0.5) / rows - 1, angle = 2 * pi * (k + 0.5) / columns;
                const double across = std::sqrt(1 - z * z);
                const Vec3d d{z, across * std::cos(angle), across * std::sin(angle)};
                double way = 1e30;
                for (int axis = 0; axis < 3; ++axis) {
                    const double from = axis == 0 ? x : side / 2;
                    way = std::min(way, (d[axis] > 0 ? side - from : from) / std::abs(d[axis]));
                }
                const double radiance = std::exp(-absorption * way) / (rows * columns);
                phi += radiance, ahead += 3 * radiance * d.x;
            }
        const auto& found = at(*lattice, {x, side / 2, side / 2}, 0);
        const double within =
            static_cast<double>(found.slope[0]) / h * (std::floor(x / h) * h + h / 2 - x);
        EXPECT_NEAR(double{found.phi} - within, phi, 0.05 * phi) << x;
        EXPECT_NEAR(found.ahead[0], ahead, 0.05) << x;
    }
}

/// Of a sun of irradiance E, exp(-sigma_t x) E is left at depth x.
TEST(RadianceLattice, KnowsWhatIsLeftOfTheSun) {
    const Rgb sun{3, 2, 1};
    const auto lattice =
        RadianceLattice::make(cube({0.3f, 0.2f, 0.1f}, {0.1f, 0.1f, 0.5f}),
                              {.environment = {}, .sun = sun, .towardsSun = {-1, 0, 0}});
    ASSERT_TRUE(lattice);
    const double h = 1 / length(lattice->latticeFromWorld().column[0]);
    const double extinction[3] = {0.4, 0.3, 0.6};
    for (double x = h / 2; x < side; x += h)
        for (int c = 0; c < 3; ++c) {
            const double expected = double{sun[c]} * std::exp(-extinction[c] * x);
            EXPECT_NEAR(at(*lattice, {x, side / 2, side / 2}, c).sun, expected, 0.01 * expected);
        }
}

/// In a thin cube the mean radiance of what is scattered once is sigma_s E / (4 pi) times the mean
/// way to the surface; 24 ordinates know that to 6 %.
TEST(RadianceLattice, HasWhatIsScatteredOnce) {
    const double scattering = 1e-4;
    const auto lattice =
        RadianceLattice::make(cube(Rgb(static_cast<float>(scattering)), {}),
                              {.environment = {}, .sun = Rgb(2.0f), .towardsSun = {0, 0, 1}});
    ASSERT_TRUE(lattice);
    double way = 0;  // the mean from the centre of a unit cube
    constexpr int steps = 400;
    for (int i = 0; i < steps; ++i)
        for (int k = 0; k < steps; ++k) {
            // On a face, at distance 1/2: the way, over the solid angle of a piece.
            const double u = (i + 0.5) / steps - 0.5, v = (k + 0.5) / steps - 0.5;
            const double r2 = 0.25 + u * u + v * v;
            way += 6 * std::sqrt(r2) * 0.5 / (r2 * std::sqrt(r2)) / (steps * steps) / (4 * pi);
        }
    const double expected = scattering * 2 / (4 * pi) * way * side;
    EXPECT_NEAR(at(*lattice, Vec3d{1, 1, 1} * (side / 2 + 1e-6), 0).phi, expected, 0.06 * expected);
}

/// Nowhere is radiance negative, nor more than that around the medium.
TEST(RadianceLattice, StaysWithinBounds) {
    const auto lattice = RadianceLattice::make(cube({0.2f, 5, 40}, {0.01f, 0.3f, 30}), sky);
    ASSERT_TRUE(lattice);
    forAll(*lattice, [](int, const RadianceLattice::Cell& cell) {
        for (const RadianceLattice::Channel& c : cell.channels) {
            EXPECT_GE(c.phi, 0);
            EXPECT_LE(c.phi, 1 + 1e-5);
        }
    });
    // Little of it comes through where much is absorbed.
    EXPECT_LT(at(*lattice, {side / 2, side / 2, side / 2}, 2).phi, 1e-5);
    EXPECT_GT(at(*lattice, {side / 2, side / 2, side / 2}, 0).phi, 0.5);
}

/// Of a grey medium it is one channel, of the lights' mean colour.
TEST(RadianceLattice, IsOfOneChannelWhereTheMediumIsGrey) {
    const Rgb around{0.5f, 1, 3};
    const auto lattice =
        RadianceLattice::make(cube(Rgb(2.0f), Rgb(0.5f)), {.environment = around, .sun = {}});
    ASSERT_TRUE(lattice);
    for (int c = 0; c < 3; ++c) {
        EXPECT_FLOAT_EQ(lattice->unit()[c], around[c] / 1.5f);
        EXPECT_NEAR(at(*lattice, {-0.01, 1, 1}, c).phi, 1.5, 1e-5);
    }
}

TEST(RadianceLattice, HasTheLightAroundOutsideOfTheMedium) {
    const Rgb around{0.5f, 2, 7};
    const auto lattice = RadianceLattice::make(cube({5, 5, 2}, {0.3f, 0.3f, 1}),
                                               {.environment = around, .sun = {1, 1, 1}});
    ASSERT_TRUE(lattice);
    for (const double x : {-0.01, side + 0.01})
        for (int c = 0; c < 3; ++c) {
            const auto& outside = at(*lattice, {x, side / 2, side / 2}, c);
            EXPECT_NEAR(outside.phi, around[c], 1e-5 * around[c]);
            EXPECT_NEAR(outside.ahead[0], 0, 1e-5 * around[c]);
        }
}

/// Also of a phase function so peaked that its mean cosine is 1 to floats.
TEST(RadianceLattice, IsFinite) {
    for (const double g : {1 - 1e-9, 0.9999, -0.9999, -1 + 1e-9}) {
        const medium::Medium medium = PlainMedium({{.grid = {},
                                                    .box = {{0, 0, 0}, {side, side, side}},
                                                    .absorption = Rgb(0.1f),
                                                    .scattering = Rgb(2.0f),
                                                    .g = g}})
                                          .medium();
        RadianceLattice::Light light = sky;
        light.sun = {1, 2, 3};
        const auto lattice = RadianceLattice::make(medium, light);
        ASSERT_TRUE(lattice);
        forAll(*lattice, [](int i, const RadianceLattice::Cell& cell) {
            for (const RadianceLattice::Channel& c : cell.channels) {
                ASSERT_TRUE(std::isfinite(c.phi) && std::isfinite(c.sun)) << i;
                for (int axis = 0; axis < 3; ++axis)
                    ASSERT_TRUE(std::isfinite(c.slope[axis]) && std::isfinite(c.ahead[axis])) << i;
            }
        });
    }
}

TEST(RadianceLattice, NeedsLightAndScattering) {
    EXPECT_TRUE(RadianceLattice::make(cube({1, 2, 1}, {}), sky));
    EXPECT_FALSE(RadianceLattice::make(cube({1, 1, 1}, {}), sky));  // a furnace
    EXPECT_FALSE(RadianceLattice::make(cube({1, 1, 1}, {}), {}));
    EXPECT_FALSE(RadianceLattice::make(cube({}, {1, 1, 1}), sky));
}

}  // namespace
}  // namespace woodcock::test
