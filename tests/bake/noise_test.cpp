// SPDX-License-Identifier: Apache-2.0
#include "woodcock/bake/noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "woodcock/base/random.h"

namespace woodcock::test {

using namespace bake;

namespace {

Vec3d randomPoint(RandomStream& random, double reach) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    return (Vec3d{x, y, z} * 2 - Vec3d{1, 1, 1}) * reach;
}

TEST(Noise, PerlinVanishesAtLatticePoints) {
    for (int i = -3; i < 4; ++i)
        for (int j = -3; j < 4; ++j) EXPECT_EQ(perlinNoise({i * 1.0, j * 1.0, 2}, 0, 7), 0);
}

TEST(Noise, GradientIsTheSlopeOfTheNoise) {
    RandomStream random(1);
    for (int i = 0; i < 200; ++i) {
        const Vec3d p = randomPoint(random, 20);
        const double w = random.uniform() * 3;
        const NoiseGradient g = perlinGradient(p, w, 5);
        EXPECT_NEAR(g.value, perlinNoise(p, w, 5), 1e-12);
        for (int axis = 0; axis < 3; ++axis) {
            Vec3d step;
            step[axis] = 1e-5;
            EXPECT_NEAR(g.gradient[axis],
                        (perlinNoise(p + step, w, 5) - perlinNoise(p - step, w, 5)) / 2e-5, 1e-6);
        }
    }
}

TEST(Noise, PerlinIsNeverSteeperThanItsBound) {
    RandomStream random(2);
    double steepest = 0;
    for (int i = 0; i < 200000; ++i) {
        const Vec3d g = perlinGradient(randomPoint(random, 50), 0, 3).gradient;
        steepest = std::max({steepest, std::abs(g.x), std::abs(g.y), std::abs(g.z)});
    }
    EXPECT_LE(steepest, perlinSlope);
    EXPECT_GE(steepest, perlinSlope / 2) << "the bound is looser than it need be";
}

// Neighbours 1e-6 apart differ by no more than any noise of unit wavelength can rise there: no
// seams between the cells of a lattice.
TEST(Noise, IsContinuous) {
    RandomStream random(3);
    for (int i = 0; i < 100000; ++i) {
        const Vec3d p = randomPoint(random, 5), q = p + randomPoint(random, 1e-6);
        EXPECT_NEAR(perlinNoise(p, 0.3, 1), perlinNoise(q, 0.3, 1), 2e-5);
        EXPECT_NEAR(simplexNoise(p, 1), simplexNoise(q, 1), 2e-5);
        const CellDistances a = cellNoise(p, 0.3, 1), b = cellNoise(q, 0.3, 1);
        const double apart = length(p - q) * (1 + 1e-9) + 1e-15;  // distances change no faster
        EXPECT_LE(std::abs(a.first - b.first), apart);
        EXPECT_LE(std::abs(a.second - b.second), apart);
        EXPECT_LE(a.first, a.second);
    }
}

TEST(Noise, IsContinuousInTime) {
    RandomStream random(4);
    for (int i = 0; i < 2000; ++i) {
        const Vec3d p = randomPoint(random, 5);
        for (const double w : {0.5, 1.0, 2.0}) {  // at whole numbers the slices change
            EXPECT_NEAR(perlinNoise(p, w - 1e-9, 1), perlinNoise(p, w, 1), 1e-7);
            EXPECT_NEAR(cellNoise(p, w - 1e-9, 1).first, cellNoise(p, w, 1).first, 1e-7);
        }
    }
}

// What gradient noise is taken for: mean zero, and the whole of [-1, 1] nearly used.
TEST(Noise, HasNoBiasAndFillsItsRange) {
    RandomStream random(5);
    double perlin = 0, simplex = 0, highest = 0, highestSimplex = 0;
    constexpr int n = 400000;
    for (int i = 0; i < n; ++i) {
        const Vec3d p = randomPoint(random, 500);
        const double a = perlinNoise(p, 0, 9), b = simplexNoise(p, 9);
        perlin += a, simplex += b;
        highest = std::max(highest, std::abs(a)),
        highestSimplex = std::max(highestSimplex, std::abs(b));
    }
    EXPECT_NEAR(perlin / n, 0, 4 * 0.27 / std::sqrt(n));
    EXPECT_NEAR(simplex / n, 0, 4 * 0.4 / std::sqrt(n));
    EXPECT_GT(highest, 0.85);
    EXPECT_GT(highestSimplex, 0.85);
}

// Points are found once for a box of places; cells are passed over where no point can be near.
TEST(Noise, CachedCellsAreTheSame) {
    RandomStream random(6);
    for (const double size : {0.01, 0.5, 3.0, 30.0}) {
        const Vec3d low = randomPoint(random, 10);
        const Box3d box{low, low + Vec3d{1, 1, 1} * size};
        const CellCache cells(box, 0.3, 4);
        for (int i = 0; i < 300; ++i) {
            const double x = random.uniform(), y = random.uniform(), z = random.uniform();
            const Vec3d p = min(low + Vec3d{x, y, z} * size, box.upper);
            const CellDistances a = cells.distances(p), b = cellNoise(p, 0.3, 4);
            ASSERT_EQ(a.first, b.first);
            ASSERT_EQ(a.second, b.second);
            ASSERT_EQ(cells.nearest(p), b.first);
        }
    }
}

// A cell's point is where the first distance vanishes. Seen from anywhere, it is no nearer than the
// distance there says: no point is missed by looking at too few cells.
TEST(Noise, CellsFindTheNearestPoint) {
    RandomStream random(7);
    int found = 0;
    for (int i = 0; i < 300; ++i) {
        Vec3d q = randomPoint(random, 5);
        double d = cellNoise(q, 0, 2).first;
        for (int step = 0; step < 2000 && d > 1e-6; ++step) {
            const Vec3d there = q + normalize(randomPoint(random, 1)) * (d * 0.3);
            const double other = cellNoise(there, 0, 2).first;
            if (other < d) q = there, d = other;
        }
        if (d > 1e-6) continue;
        ++found;
        for (int k = 0; k < 200; ++k) {
            const Vec3d p = q + randomPoint(random, 1);
            ASSERT_LE(cellNoise(p, 0, 2).first, length(p - q) + 2e-6);
        }
    }
    EXPECT_GT(found, 200);
}

TEST(Noise, SeedsGiveOtherNoises) {
    const Vec3d p{0.3, 0.4, 0.7};
    EXPECT_NE(perlinNoise(p, 0, 1), perlinNoise(p, 0, 2));
    EXPECT_NE(simplexNoise(p, 1), simplexNoise(p, 2));
    EXPECT_NE(cellNoise(p, 0, 1).first, cellNoise(p, 0, 2).first);
    EXPECT_NE(perlinNoise(p, 0, 1), perlinNoise(p, 0.5, 1));
}

TEST(Noise, IsFiniteFarAway) {
    for (const double x : {1e9, 1e18, 1e300, -1e300}) {
        EXPECT_TRUE(std::isfinite(perlinNoise({x, 0.5, 0.5}, x, 1)));
        EXPECT_TRUE(std::isfinite(simplexNoise({x, 0.5, 0.5}, 1)));
        EXPECT_TRUE(std::isfinite(cellNoise({x, 0.5, 0.5}, x, 1).first));
    }
}

}  // namespace
}  // namespace woodcock::test
