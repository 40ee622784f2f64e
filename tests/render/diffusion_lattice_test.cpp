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

const DiffusionLattice::Channel& at(const DiffusionLattice& lattice, Vec3d world, int channel) {
    const Vec3i cell = floorToInt(lattice.latticeFromWorld().point(world));
    const Vec3i n = lattice.cells();
    return lattice.content()[(cell.z * n.y + cell.y) * n.x + cell.x].channels[channel];
}

/// Far from the other faces phi falls as exp(-x sqrt(3 sigma_a sigma_tr)). Between cells of edge h
/// the finite volumes' solution falls by r, where r + 1 / r = 2 + 3 sigma_a sigma_tr h^2.
TEST(DiffusionLattice, FallsByTheDiffusionLength) {
    const auto lattice = DiffusionLattice::make(cube({5, 5, 2}, {0.3f, 0.3f, 1}));
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
    const auto lattice = DiffusionLattice::make(cube({0.2f, 5, 40}, {0.01f, 0.3f, 30}));
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

TEST(DiffusionLattice, NeedsBothAbsorptionAndScattering) {
    EXPECT_FALSE(DiffusionLattice::make(cube({1, 1, 1}, {})));
    EXPECT_FALSE(DiffusionLattice::make(cube({}, {1, 1, 1})));
}

}  // namespace
}  // namespace woodcock::test
