// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <vector>

#include "woodcock/base/random.h"
#include "woodcock/medium/phase.h"
#include "woodcock/render/lanes/lane_rows-inl.h"

namespace woodcock::render::HWY_NAMESPACE {

namespace {

using Words = std::array<std::uint32_t, 4>;

template <int Rounds>
Words threefryOf(const Words& counter, const Words& key) {
    U keys[4], counters[4], words[4];
    Words result;
    for (std::size_t i = 0; i < 4; ++i)
        keys[i] = hn::Set(lanesU, key[i]), counters[i] = hn::Set(lanesU, counter[i]);
    threefry<Rounds>(keys, counters, words);
    for (std::size_t i = 0; i < 4; ++i) {
        Row<std::uint32_t> row;
        row.set(words[i]);
        for (std::size_t lane = 1; lane < laneCount; ++lane) EXPECT_EQ(row[lane], row[0]);
        result[i] = row[0];
    }
    return result;
}

/// The same as the paper has it, number by number.
Words plainThreefry(Words x, const Words& key, std::uint32_t rounds) {
    constexpr int turns[8][2]{{10, 26}, {11, 21}, {13, 27}, {23, 5},
                              {6, 20},  {17, 11}, {25, 10}, {18, 20}};
    std::uint32_t keys[5]{key[0], key[1], key[2], key[3], 0x1BD11BDA};
    for (std::size_t i = 0; i < 4; ++i) keys[4] ^= key[i], x[i] += key[i];
    for (std::uint32_t round = 0; round < rounds; ++round) {
        x[0] += x[1], x[2] += x[3];
        x[1] = std::rotl(x[1], turns[round % 8][0]) ^ x[0];
        x[3] = std::rotl(x[3], turns[round % 8][1]) ^ x[2];
        std::swap(x[1], x[3]);  // the permutation of four words
        if (round % 4 < 3) continue;
        const std::uint32_t injection = (round + 1) / 4;
        for (std::uint32_t i = 0; i < 4; ++i) x[i] += keys[(injection + i) % 5];
        x[3] += injection;
    }
    return x;
}

/// The largest |error(value, truth)| of a function of one number over many of them.
double largestError(const std::function<F(F)>& function, const std::vector<float>& xs,
                    const std::function<double(float x, float value)>& error) {
    double largest = 0;
    for (const float x : xs) {
        Floats row;
        row.set(function(all(x)));
        largest = std::max(largest, std::abs(error(x, row[laneCount - 1])));
    }
    return largest;
}

/// In units of the truth's last place.
double ulps(float value, double truth) {
    const int exponent = std::ilogb(static_cast<float>(truth));
    return (double{value} - truth) / std::ldexp(1.0, exponent - 23);
}

std::vector<float> spread(double low, double high, int count, bool logarithmic) {
    std::vector<float> xs;
    for (int i = 0; i <= count; ++i) {
        const double part = i / static_cast<double>(count);
        xs.push_back(static_cast<float>(logarithmic ? low * std::pow(high / low, part)
                                                    : low + (high - low) * part));
    }
    return xs;
}

}  // namespace

/// kat_vectors of Random123: counter, key.
TEST(LaneMath, ThreefryGivesThePublishedWords) {
    const Words zeros{}, ones{~0u, ~0u, ~0u, ~0u};
    const Words pi{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344},
        morePi{0xa4093822, 0x299f31d0, 0x082efa98, 0xec4e6c89};
    EXPECT_EQ(threefryOf<20>(zeros, zeros),
              (Words{0x9c6ca96a, 0xe17eae66, 0xfc10ecd4, 0x5256a7d8}));
    EXPECT_EQ(threefryOf<20>(ones, ones), (Words{0x2a881696, 0x57012287, 0xf6c7446e, 0xa16a6732}));
    EXPECT_EQ(threefryOf<20>(pi, morePi), (Words{0x59cd1dbb, 0xb8879579, 0x86b5d00c, 0xac8b6d84}));
    EXPECT_EQ(threefryOf<13>(zeros, zeros),
              (Words{0x531c7e4f, 0x39491ee5, 0x2c855a92, 0x3d6abf9a}));
    EXPECT_EQ(threefryOf<13>(ones, ones), (Words{0xc4189358, 0x1c9cc83a, 0xd5881c67, 0x6a0a89e0}));
    EXPECT_EQ(threefryOf<13>(pi, morePi), (Words{0x4aa71d8f, 0x734738c2, 0x431fc6a8, 0xae6debf1}));
}

TEST(LaneMath, ThreefryOfTwelveRoundsIsThePapers) {
    ASSERT_EQ(plainThreefry({}, {}, 20), (Words{0x9c6ca96a, 0xe17eae66, 0xfc10ecd4, 0x5256a7d8}));
    RandomStream random(1);
    for (int i = 0; i < 1000; ++i) {
        const std::uint64_t a = random.bits(), b = random.bits();
        const Words counter{static_cast<std::uint32_t>(i), 0, 0, 0},
            key{static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(a >> 32),
                static_cast<std::uint32_t>(b), 0};
        ASSERT_EQ(threefryOf<12>(counter, key), plainThreefry(counter, key, 12));
    }
}

TEST(LaneMath, LogarithmsAreRightToThreePlaces) {
    const auto error = [](float x, float value) { return ulps(value, std::log(double{x})); };
    EXPECT_LE(largestError(logarithm, spread(1e-30, 1e30, 200001, true), error), 3);
    auto nearOne = spread(0.9, 1.1, 200001, false);
    std::erase(nearOne, 1.0f);
    EXPECT_LE(largestError(logarithm, nearOne, error), 3);
    for (float x = 1; x > 0.9999f;) {
        x = std::nextafter(x, 0.0f);
        ASSERT_LE(largestError(logarithm, {x}, error), 3) << x;
    }
    EXPECT_EQ(largestError(logarithm, {1}, [](float, float value) { return value; }), 0);
}

/// A relative error of an argument's product grows with it.
TEST(LaneMath, DecaysAreRightToAFewPlaces) {
    const auto error = [](float x, float value) {
        return ulps(value, std::exp(-double{x})) / (3 + 1.5 * double{x});
    };
    EXPECT_LE(largestError(decay, spread(1e-30, 1, 100001, true), error), 1);
    EXPECT_LE(largestError(decay, spread(0, 87, 400001, false), error), 1);
    const auto value = [](float, float v) { return v; };
    EXPECT_EQ(largestError(decay, {0}, value), 1);
    EXPECT_EQ(largestError(decay, {87.5f, 1e30f}, value), 0);
}

TEST(LaneMath, SinesAndCosinesAreRight) {
    constexpr int count = 400001;
    for (int i = 0; i < count; ++i) {
        const float u = static_cast<float>(i) / count;
        F s, c;
        sineAndCosine(all(u), s, c);
        Floats sine, cosine;
        sine.set(s), cosine.set(c);
        ASSERT_NEAR(sine[0], std::sin(2 * M_PI * double{u}), 2e-7) << u;
        ASSERT_NEAR(cosine[0], std::cos(2 * M_PI * double{u}), 2e-7) << u;
    }
}

/// Kolmogorov and Smirnov's distance of so many draws from 1 - exp(-x), times sqrt(n): above 2.2
/// once in 8000 times.
TEST(LaneMath, DepthsAreExponential) {
    RandomStream random(3);
    std::vector<double> depths(200000);
    for (double& depth : depths) {
        Floats row;
        row.set(drawDepth(hn::Set(lanesU, static_cast<std::uint32_t>(random.bits() >> 32))));
        depth = double{row[0]};
    }
    std::ranges::sort(depths);
    double distance = 0;
    const auto n = static_cast<double>(depths.size());
    for (std::size_t i = 0; i < depths.size(); ++i) {
        const double below = -std::expm1(-depths[i]);
        distance = std::max(
            {distance, below - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - below});
    }
    EXPECT_LE(distance * std::sqrt(n), 2.2);
}

/// The ends of a depth's range, and steps between neighbours there.
TEST(LaneMath, DepthsReachAsFarAsTheirBits) {
    const auto depthOf = [](std::uint32_t bits) {
        Floats row;
        row.set(drawDepth(hn::Set(lanesU, bits)));
        return double{row[0]};
    };
    EXPECT_NEAR(depthOf(0), 33 * std::log(2.0), 1e-5);
    EXPECT_NEAR(depthOf(1), -std::log(1.5) + 32 * std::log(2.0), 1e-5);
    EXPECT_NEAR(depthOf(0x80000000), std::log(2.0), 1e-6);
    EXPECT_NEAR(depthOf(~0u), 0, 1e-7);
    EXPECT_GE(depthOf(~0u), 0);
}

TEST(LaneMath, TurnsAreThoseOfThePhaseFunction) {
    RandomStream random(5);
    for (const float g : {-0.9f, -0.3f, 0.0f, 0.5f, 0.85f, 0.99f}) {
        const medium::PhaseFunction phase = medium::HenyeyGreenstein(double{g});
        for (int i = 0; i < 3000; ++i) {
            const Vec3d forward = normalize(
                Vec3d{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5});
            const auto draw = [&] {  // as uniform() has them
                return static_cast<float>(random.bits() >> 40) * 0x1p-24f;
            };
            const float u0 = draw(), u1 = draw();
            Floats v[3], density;
            const V3 from{all(static_cast<float>(forward.x)), all(static_cast<float>(forward.y)),
                          all(static_cast<float>(forward.z))};
            F d;
            const V3 turned = sampleHenyeyGreenstein(from, all(g), all(u0), all(u1), d);
            v[0].set(turned.x), v[1].set(turned.y), v[2].set(turned.z), density.set(d);
            const Vec3d to{v[0][0], v[1][0], v[2][0]};
            const medium::PhaseSample truth = phase.sample(forward, double{u0}, double{u1});
            ASSERT_NEAR(length(to), 1, 3e-7);
            ASSERT_LE(length(to - truth.direction), 4e-6) << "g " << g;
            ASSERT_NEAR(density[0] / truth.pdf, 1, 2e-5) << "g " << g;
        }
    }
}

}  // namespace woodcock::render::HWY_NAMESPACE
