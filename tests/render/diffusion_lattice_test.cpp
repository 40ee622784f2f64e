// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/diffusion_lattice.h"

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

const DiffusionLattice::Light sky{.environment = {1, 1, 1}, .sun = {}};

const DiffusionLattice::Channel& at(const DiffusionLattice& lattice, Vec3d world, int channel) {
    const Vec3i cell = floorToInt(lattice.latticeFromWorld().point(world));
    const Vec3i n = lattice.cells();
    return lattice.content()[(cell.z * n.y + cell.y) * n.x + cell.x].channels[channel];
}

/// Far from the other faces phi falls as exp(-x sqrt(3 sigma_a sigma_tr)). Between cells of edge h
/// the finite volumes' solution falls by r, where r + 1 / r = 2 + 3 sigma_a sigma_tr h^2.
TEST(DiffusionLattice, FallsByTheDiffusionLength) {
    const auto lattice = DiffusionLattice::make(cube({5, 5, 2}, {0.3f, 0.3f, 1}), sky);
    ASSERT_TRUE(lattice);
    const double h = 1 / length(lattice->latticeFromWorld().column[0]);
    for (const int channel : {0, 2}) {
        const double absorption = channel == 0 ? 0.3 : 1, transport = channel == 0 ? 5.3 : 3;
        const double square = 3 * absorption * transport * h * h;
        const double expected = 1 + square / 2 - std::sqrt(square + square * square / 4);
        for (double x = 0.7; x < 1.6; x += h) {
            const auto& here = at(*lattice, {x, side / 2, side / 2}, channel);
            const auto& next = at(*lattice, {x + h, side / 2, side / 2}, channel);
            EXPECT_NEAR(next.phi / here.phi, expected, 0.01 * expected) << x;
            EXPECT_LT(here.slope[0], 0);
            EXPECT_NEAR(here.slope[1], 0, 1e-3);
            EXPECT_NEAR(
                here.path,
                std::min(1 / (transport * h), double{here.phi} / std::abs(double{here.slope[0]})),
                1e-3);
        }
    }
}

/// Radiance is at most that around the medium, and nowhere expected to be negative.
TEST(DiffusionLattice, StaysWithinBounds) {
    const auto lattice = DiffusionLattice::make(cube({0.2f, 5, 40}, {0.01f, 0.3f, 30}), sky);
    ASSERT_TRUE(lattice);
    const Vec3i n = lattice->cells();
    for (int i = 0; i < n.x * n.y * n.z; ++i)
        for (const DiffusionLattice::Channel& c : lattice->content()[i].channels) {
            EXPECT_GE(c.phi, 0);
            EXPECT_LE(c.phi, 1);
            EXPECT_LE(c.path * std::hypot(c.slope[0], c.slope[1], c.slope[2]), c.phi + 1e-5f);
        }
    // Little of it comes through where much is absorbed.
    EXPECT_LT(at(*lattice, {side / 2, side / 2, side / 2}, 2).phi, 1e-5);
    EXPECT_GT(at(*lattice, {side / 2, side / 2, side / 2}, 0).phi, 0.5);
}

TEST(DiffusionLattice, HasTheLightAroundOutsideOfTheMedium) {
    const Rgb around{0.5f, 2, 7};
    const auto lattice = DiffusionLattice::make(cube({5, 5, 2}, {0.3f, 0.3f, 1}),
                                                {.environment = around, .sun = {1, 1, 1}});
    ASSERT_TRUE(lattice);
    for (const double x : {-0.01, side + 0.01})
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(at(*lattice, {x, side / 2, side / 2}, c).phi, around[c]);
            EXPECT_EQ(at(*lattice, {x, side / 2, side / 2}, c).path, 0);
        }
}

/// What the finite volumes of edge h lose by diffusion and absorption is what sunlight brings to
/// them: (1 - g) sigma_s E T / (4 pi), where T = exp(-sigma_tr x) at depth x.
TEST(DiffusionLattice, BalancesWhatSunlightScatters) {
    const Rgb sun{3, 2, 1};
    const auto lattice =
        DiffusionLattice::make(cube({5, 5, 2}, {0.3f, 0.3f, 1}),
                               {.environment = {}, .sun = sun, .towardsSun = {-1, 0, 0}});
    ASSERT_TRUE(lattice);
    const double h = 1 / length(lattice->latticeFromWorld().column[0]);
    for (const int channel : {0, 1, 2}) {
        const double scattering = channel < 2 ? 5 : 2, absorption = channel < 2 ? 0.3 : 1,
                     transport = scattering + absorption;
        const auto phi = [&](double x, double y, double z) {
            return double{at(*lattice, {x, side / 2 + y, side / 2 + z}, channel).phi};
        };
        for (double x = 1.5 * h; x < 1; x += h) {
            const double around = phi(x + h, 0, 0) + phi(x - h, 0, 0) + phi(x, h, 0) +
                                  phi(x, -h, 0) + phi(x, 0, h) + phi(x, 0, -h);
            const double lost =
                absorption * h * phi(x, 0, 0) - (around - 6 * phi(x, 0, 0)) / (3 * transport * h);
            const double brought =
                scattering * h * double{sun[channel]} * std::exp(-transport * x) / (4 * pi);
            EXPECT_NEAR(lost, brought, 0.01 * brought) << x;
        }
    }
}

/// Light adds up.
TEST(DiffusionLattice, IsLinearInTheLight) {
    const medium::Medium medium = cube({5, 5, 2}, {0.3f, 0.3f, 1});
    const DiffusionLattice::Light sun{
        .environment = {}, .sun = {3, 2, 1}, .towardsSun = {0.6, 0, 0.8}};
    DiffusionLattice::Light both = sun;
    both.environment = sky.environment;
    const auto a = DiffusionLattice::make(medium, sky), b = DiffusionLattice::make(medium, sun),
               sum = DiffusionLattice::make(medium, both);
    ASSERT_TRUE(a && b && sum);
    for (double x = 0.5; x < side; ++x)
        for (const int c : {0, 2}) {
            const Vec3d p{x, side / 3, side - x};
            EXPECT_NEAR(at(*sum, p, c).phi, at(*a, p, c).phi + at(*b, p, c).phi, 1e-5);
        }
}

TEST(DiffusionLattice, NeedsBothAbsorptionAndScattering) {
    EXPECT_FALSE(DiffusionLattice::make(cube({1, 1, 1}, {}), sky));
    EXPECT_FALSE(DiffusionLattice::make(cube({}, {1, 1, 1}), sky));
}

}  // namespace
}  // namespace woodcock::test
