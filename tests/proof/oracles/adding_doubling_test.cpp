// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/oracles/adding_doubling.h"

#include <gtest/gtest.h>

#include <random>

#include "woodcock/base/error.h"
#include "woodcock/base/vec.h"
#include "woodcock/proof/oracles/chandrasekhar.h"
#include "woodcock/proof/oracles/closed_forms.h"
#include "woodcock/proof/oracles/quadrature.h"

namespace woodcock::oracle {

using namespace oracle;

namespace {

const std::vector<double> angles{1, 0.8, 0.5, 0.1, 0.01};

void expectNear(const Face& a, const Face& b, double error) {
    for (std::size_t i = 0; i < a.reflectance.size(); ++i) {
        EXPECT_NEAR(a.reflectance[i], b.reflectance[i], error) << "angle " << i;
        EXPECT_NEAR(a.transmittance[i], b.transmittance[i], error) << "angle " << i;
    }
    EXPECT_NEAR(a.whiteSkyReflectance, b.whiteSkyReflectance, error);
    EXPECT_NEAR(a.whiteSkyTransmittance, b.whiteSkyTransmittance, error);
}

TEST(AddingDoubling, ConservesEnergy) {
    for (const double g : {0.0, 0.5, 0.95, -0.9})
        for (const double depth : {1e-6, 0.1, 3.0, 100.0, 1e4})
            for (const double index : {1.0, 1.33}) {
                SCOPED_TRACE(testing::Message() << g << ' ' << depth << ' ' << index);
                const Slab slab{{{depth, 1, g}, {depth / 3, 1, 0.2}}, index};
                const SlabAnswer answer = solveSlab(slab, angles, 24);
                for (const Face& f : {answer.above, answer.below}) {
                    for (std::size_t i = 0; i < angles.size(); ++i)
                        EXPECT_NEAR(f.reflectance[i] + f.transmittance[i], 1, 1e-9);
                    EXPECT_NEAR(f.whiteSkyReflectance + f.whiteSkyTransmittance, 1, 1e-9);
                }
            }
}

TEST(AddingDoubling, NothingIsInTheWayOfAnEmptySlab) {
    for (const Slab& slab : {Slab{}, Slab{{{0, 0.5, 0.9}}}}) {
        const Face f = solveSlab(slab, angles).above;
        for (std::size_t i = 0; i < angles.size(); ++i) {
            EXPECT_EQ(f.reflectance[i], 0);
            EXPECT_NEAR(f.transmittance[i], 1, 1e-14);
        }
        EXPECT_NEAR(f.whiteSkyTransmittance, 1, 1e-13);
    }
}

TEST(AddingDoubling, PureAbsorptionIsBeerLambert) {
    for (const double depth : {1e-10, 0.3, 5.0, 200.0}) {
        const Face f = solveSlab({{{depth, 0, 0.7}}}, angles).above;
        for (std::size_t i = 0; i < angles.size(); ++i) {
            EXPECT_EQ(f.reflectance[i], 0);
            EXPECT_NEAR(f.transmittance[i], slabTransmittance(depth, angles[i]), 1e-8);
        }
        const double diffuse = tanhSinh(
            [=](double mu, double) { return 2 * mu * slabTransmittance(depth, mu); }, 0, 1);
        EXPECT_NEAR(f.whiteSkyTransmittance, diffuse, 1e-8);
    }
    // More grazing than any node, so that it is this angle that the thinnest layer is chosen for
    EXPECT_NEAR(solveSlab({{{1e-4, 0, 0}}}, {1e-4}).above.transmittance[0], std::exp(-1), 1e-8);
}

TEST(AddingDoubling, ALayerIsTheSumOfItsParts) {
    for (const double g : {0.0, 0.75, 0.95, -0.5}) {
        SCOPED_TRACE(g);
        const SlabAnswer whole = solveSlab({{{2, 0.95, g}}}, angles, 32);
        const SlabAnswer parts = solveSlab(
            {{{0.6, 0.95, g}, {0, 0.1, 0.1}, {1e-3, 0.95, g}, {1.399, 0.95, g}}}, angles, 32);
        expectNear(whole.above, parts.above, 1e-9);
        expectNear(whole.below, parts.below, 1e-9);
        expectNear(whole.above, whole.below, 1e-14);
    }
}

TEST(AddingDoubling, AStackUpsideDownSwapsItsFaces) {
    const Layer a{0.5, 0.9, 0.8}, b{2, 0.6, -0.3}, c{0.1, 1, 0};
    const SlabAnswer upright = solveSlab({{a, b, c}, 1.4}, angles, 32);
    const SlabAnswer upsideDown = solveSlab({{c, b, a}, 1.4}, angles, 32);
    expectNear(upright.above, upsideDown.below, 1e-12);
    expectNear(upright.below, upsideDown.above, 1e-12);
    EXPECT_GT(std::abs(upright.above.reflectance[0] - upright.below.reflectance[0]), 0.01);
}

TEST(AddingDoubling, DiffuseLightPassesEquallyBothWays) {
    const SlabAnswer s = solveSlab({{{0.5, 0.9, 0.8}, {2, 0.6, -0.3}}, 1.5}, {}, 32);
    EXPECT_NEAR(s.above.whiteSkyTransmittance, s.below.whiteSkyTransmittance, 1e-12);
}

TEST(AddingDoubling, DiffuseAnswersAreTheMeanOverAngles) {
    const Quadrature rule = gaussLegendre(40);
    for (const double index : {1.0, 1.5}) {
        const Face f = solveSlab({{{1, 0.9, 0.6}, {0.5, 0.3, 0}}, index}, rule.nodes).above;
        double reflected = 0, transmitted = 0;
        for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
            reflected += 2 * rule.nodes[i] * rule.weights[i] * f.reflectance[i];
            transmitted += 2 * rule.nodes[i] * rule.weights[i] * f.transmittance[i];
        }
        EXPECT_NEAR(reflected, f.whiteSkyReflectance, 1e-7);
        EXPECT_NEAR(transmitted, f.whiteSkyTransmittance, 1e-7);
    }
}

TEST(AddingDoubling, ThinSlabsScatterOnce) {
    constexpr double depth = 1e-9, albedo = 0.7;
    for (const double g : {0.0, 0.5, 0.85, -0.7})
        for (const double mu0 : {1.0, 0.8, 0.5, 0.1}) {
            SCOPED_TRACE(testing::Message() << g << ' ' << mu0);
            const auto phase = [&](double mu) {
                return azimuthMeanOfHenyeyGreenstein(mu, mu0, g) / (4 * pi);
            };
            const auto back = [&](double mu, double) {
                return 2 * pi * mu / mu0 *
                       singleScatterReflected(depth, albedo, phase(-mu), mu, mu0);
            };
            const auto forth = [&](double mu, double) {
                return 2 * pi * mu / mu0 *
                       singleScatterTransmitted(depth, albedo, phase(mu), mu, mu0);
            };
            // In two parts, as the peak is a kink for the quadrature.
            const double reflected = tanhSinh(back, 0, mu0) + tanhSinh(back, mu0, 1);
            const double transmitted = tanhSinh(forth, 0, mu0) + tanhSinh(forth, mu0, 1);
            const Face f = solveSlab({{{depth, albedo, g}}}, {mu0}).above;
            EXPECT_NEAR(f.reflectance[0] / reflected, 1, 1e-6);
            EXPECT_NEAR((f.transmittance[0] - slabTransmittance(depth, mu0)) / transmitted, 1,
                        1e-5);
        }
}

TEST(AddingDoubling, DeepIsotropicSlabsAreChandrasekharsHalfSpace) {
    for (const double albedo : {0.2, 0.5, 0.9, 0.99, 0.9999}) {
        SCOPED_TRACE(albedo);
        const Face f = solveSlab({{{5000, albedo, 0}}}, angles).above;
        for (std::size_t i = 0; i < angles.size(); ++i) {
            EXPECT_NEAR(f.reflectance[i], halfSpaceAlbedo(albedo, angles[i]), 1e-7);
            EXPECT_NEAR(f.transmittance[i], 0, 1e-12);
        }
        EXPECT_NEAR(f.whiteSkyReflectance, halfSpaceWhiteSkyAlbedo(albedo), 1e-8);
    }
}

// van de Hulst 1980, section 5.3: what escapes is sqrt(3) / 4 H, and Hopf's constant lengthens the
// way at both ends.
TEST(AddingDoubling, DeepConservativeSlabsTransmitByDiffusion) {
    for (const double depth : {30.0, 1e3, 1e4}) {
        SCOPED_TRACE(depth);
        const double diffuse = 4 / (3 * (depth + 2 * hopfConstant()));
        const Face f = solveSlab({{{depth, 1, 0}}}, angles).above;
        for (std::size_t i = 0; i < angles.size(); ++i) {
            const double beam = diffuse * std::sqrt(3.0) / 4 * chandrasekharH(1, angles[i]);
            EXPECT_NEAR(f.transmittance[i] / beam, 1, 3e-7) << angles[i];
        }
        EXPECT_NEAR(f.whiteSkyTransmittance / diffuse, 1, 3e-7);
    }
}

// Giovanelli's half-space by another way: Chandrasekhar's reflection inside, and light sent back
// at the boundary again and again.
TEST(AddingDoubling, RefractionAgreesWithHFunctions) {
    constexpr double index = 1.5, albedo = 0.9;
    struct Direction {
        double mu, weight, reflectance, H;
    };
    std::vector<Direction> all;
    const Quadrature rule = gaussLegendre(48);
    const double critical = std::sqrt(1 - 1 / (index * index));
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
        const double outside = rule.nodes[i], t = critical * outside;
        const double mu = std::sqrt(1 - (1 - outside * outside) / (index * index));
        all.push_back({mu, rule.weights[i] * outside / (mu * index * index),
                       fresnelReflectance(outside, index), chandrasekharH(albedo, mu)});
        all.push_back({t, critical * rule.weights[i], 1, chandrasekharH(albedo, t)});
    }
    const double H1 = chandrasekharH(albedo, 1), entering = 1 - fresnelReflectance(1, index);
    std::vector<double> first, up;
    for (const Direction& d : all)
        first.push_back(entering * albedo / (4 * pi) * d.H * H1 / (d.mu + 1));
    up = first;
    for (int bounce = 0; bounce < 100; ++bounce) {
        std::vector<double> next = first;
        for (std::size_t i = 0; i < all.size(); ++i)
            for (std::size_t j = 0; j < all.size(); ++j)
                next[i] += all[j].weight * albedo / 2 * all[j].mu / (all[i].mu + all[j].mu) *
                           all[i].H * all[j].H * all[j].reflectance * up[j];
        up = next;
    }
    double reflectance = fresnelReflectance(1, index);
    for (std::size_t i = 0; i < all.size(); ++i)
        reflectance += 2 * pi * all[i].mu * all[i].weight * (1 - all[i].reflectance) * up[i];
    EXPECT_NEAR(solveSlab({{{1000, albedo, 0}}, index}, {1}).above.reflectance[0], reflectance,
                1e-8);
}

TEST(AddingDoubling, GlassReflectsByFresnel) {
    const double n = 1.5, n2 = n * n, n4 = n2 * n2;
    const Face clear = solveSlab({{}, n}, angles).above;
    const Face black = solveSlab({{{1e3, 0, 0}}, n}, angles).above;
    for (std::size_t i = 0; i < angles.size(); ++i) {
        const double r = fresnelReflectance(angles[i], n);
        EXPECT_NEAR(clear.reflectance[i], 2 * r / (1 + r), 1e-13);
        EXPECT_NEAR(black.reflectance[i], r, 1e-13);
    }
    EXPECT_NEAR(fresnelReflectance(1, n), 0.04, 1e-15);
    const double brewster = std::cos(std::atan(n));  // where one polarisation is not reflected
    EXPECT_NEAR(fresnelReflectance(brewster, n), std::pow((n2 - 1) / (n2 + 1), 2) / 2, 1e-15);
    // The diffuse reflectance of a boundary has a closed form (Walsh 1926).
    const double walsh =
        0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
        n2 * std::pow(n2 - 1, 2) / std::pow(n2 + 1, 3) * std::log((n - 1) / (n + 1)) -
        2 * n2 * n * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
        8 * n4 * (n4 + 1) / ((n2 + 1) * std::pow(n4 - 1, 2)) * std::log(n);
    EXPECT_NEAR(black.whiteSkyReflectance, walsh, 1e-8);
}

/// Photons in a stack of layers, one by one: the part reflected, and that transmitted.
std::pair<double, double> countPhotons(const std::vector<Layer>& layers, double mu0, int count) {
    std::mt19937_64 random(1);
    const auto uniform = [&] { return (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53; };
    int reflected = 0, transmitted = 0;
    for (int photon = 0; photon < count; ++photon) {
        double mu = mu0;  // downwards
        std::ptrdiff_t layer = 0;
        double z = 0, flight = -std::log(uniform());  // z: below the top of its layer
        while (true) {
            const Layer& l = layers[static_cast<std::size_t>(layer)];
            const double room = (mu > 0 ? l.opticalDepth - z : -z) / mu;
            if (flight > room) {
                flight -= room;
                layer += mu > 0 ? 1 : -1;
                if (layer < 0 || layer == std::ssize(layers)) break;
                z = mu > 0 ? 0 : layers[static_cast<std::size_t>(layer)].opticalDepth;
                continue;
            }
            if (uniform() >= l.albedo) break;
            z += flight * mu;
            flight = -std::log(uniform());
            const double q = (1 - l.g * l.g) / (1 - l.g + 2 * l.g * uniform());
            const double turn = (1 + l.g * l.g - q * q) / (2 * l.g);
            mu = std::clamp(mu * turn + std::sqrt((1 - mu * mu) * (1 - turn * turn)) *
                                            std::cos(2 * pi * uniform()),
                            -1.0, 1.0);
        }
        if (layer < 0) ++reflected;
        if (layer == std::ssize(layers)) ++transmitted;
    }
    return {reflected / static_cast<double>(count), transmitted / static_cast<double>(count)};
}

TEST(AddingDoubling, AgreesWithPhotonsInAStack) {
    const std::vector<Layer> layers{{0.7, 0.95, 0.85}, {1.5, 0.99, -0.4}, {0.4, 0.6, 0.5}};
    constexpr int count = 400'000;
    const double error = 4 * std::sqrt(0.25 / count);  // four standard errors at the most: 0.0032
    for (const double mu0 : {1.0, 0.3}) {
        const Face f = solveSlab({layers}, {mu0}).above;
        const auto [reflected, transmitted] = countPhotons(layers, mu0, count);
        EXPECT_NEAR(f.reflectance[0], reflected, error);
        EXPECT_NEAR(f.transmittance[0], transmitted, error);
    }
}

TEST(AddingDoubling, ConvergesAsItsHeaderSays) {
    struct Claim {
        double g;
        std::size_t nodes;
        double error;
    };
    const std::vector<double> mu{1, 0.5, 0.1};
    for (const Claim& c : {Claim{0.75, 16, 3e-6},
                           {0.75, 32, 1e-7},
                           {0.9, 64, 2e-8},
                           {-0.9, 64, 2e-8},
                           {0.95, 64, 2e-6}})
        for (const double depth : {0.1, 1.0, 10.0})
            for (const double albedo : {0.9, 1.0}) {
                SCOPED_TRACE(testing::Message() << c.g << ' ' << c.nodes << ' ' << depth);
                expectNear(solveSlab({{{depth, albedo, c.g}}}, mu, c.nodes).above,
                           solveSlab({{{depth, albedo, c.g}}}, mu, 112).above, c.error);
            }
}

TEST(AddingDoubling, PhaseFunctionIsTheMeanOverAzimuth) {
    for (const double g : {0.5, 0.9, -0.95})
        for (const double from : {1.0, 0.6, -0.2})
            for (const double to : {0.99, 0.6, 0.0, -0.7}) {
                const double sines = std::sqrt((1 - from * from) * (1 - to * to));
                double mean = 0;
                constexpr int steps = 2000;  // of a periodic function: exact to rounding
                for (int k = 0; k < steps; ++k)
                    mean += henyeyGreenstein(from * to + sines * std::cos(2 * pi * k / steps), g) /
                            steps;
                EXPECT_NEAR(azimuthMeanOfHenyeyGreenstein(to, from, g) / (4 * pi * mean), 1, 1e-12);
            }
}

TEST(AddingDoubling, RefusesWhatMakesNoSense) {
    EXPECT_THROW(solveSlab({{{-1, 0.5, 0}}}, {1}), Error);
    EXPECT_THROW(solveSlab({{{1, 1.5, 0}}}, {1}), Error);
    EXPECT_THROW(solveSlab({{{1, 0.5, 1}}}, {1}), Error);
    EXPECT_THROW(solveSlab({{{1, 0.5, 0}}, 0.9}, {1}), Error);
    EXPECT_THROW(solveSlab({{{1, 0.5, 0}}}, {0}), Error);
    EXPECT_THROW(solveSlab({{{1, 0.5, 0}}}, {1}, 1), Error);
}

}  // namespace
}  // namespace woodcock::oracle
