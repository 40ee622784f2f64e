// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/polar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "woodcock/base/random.h"

namespace woodcock::test {

namespace {

Vec3d randomVector(RandomStream& random, double size) {
    return {size * (random.uniform() - 0.5), size * (random.uniform() - 0.5),
            size * (random.uniform() - 0.5)};
}

Affine3d randomMap(RandomStream& random, bool mirrors) {
    const auto turn = [&](int axis) { return Affine3d::rotate(axis, 360 * random.uniform()); };
    Vec3d s{std::pow(10, 4 * random.uniform() - 2), std::pow(10, 4 * random.uniform() - 2),
            std::pow(10, 4 * random.uniform() - 2)};
    if (mirrors) s.x = -s.x;
    return Affine3d::translate(randomVector(random, 10)) * turn(0) * turn(1) * turn(2) *
           Affine3d::scale(s) * turn(1) * turn(0);
}

double difference(const Affine3d& a, const Affine3d& b) {
    double most = length(a.translation - b.translation);
    for (std::size_t c = 0; c < 3; ++c)
        most = std::max(most, length(a.column[c] - b.column[c]) / length(b.column[c]));
    return most;
}

}  // namespace

TEST(Polar, GivesTheMapBackAndGoesBetweenRegularly) {
    RandomStream random(1);
    for (int i = 0; i < 1000; ++i) {
        const bool mirrors = i % 2;
        const Affine3d a = randomMap(random, mirrors), b = randomMap(random, mirrors);
        const PolarMap pa = polarOf(a), pb = polarOf(b);
        EXPECT_LT(difference(pa.map(), a), 1e-10);
        EXPECT_LT(difference(between(pa, pb, 0).map(), a), 1e-10);
        EXPECT_LT(difference(between(pa, pb, 1).map(), b), 1e-10);
        for (const double s : {0.1, 0.5, 0.9})
            EXPECT_GT(between(pa, pb, s).map().determinant() * a.determinant(), 0);
    }
}

TEST(Polar, TurnsEvenly) {
    for (int axis = 0; axis < 3; ++axis)
        for (const double angle : {1e-9, 1e-3, 20.0, 90.0, 179.0, -60.0}) {
            const PolarMap a = polarOf(Affine3d::rotate(axis, 30));
            const PolarMap b = polarOf(Affine3d::rotate(axis, 30 + angle));
            EXPECT_NEAR(angleBetween(a.rotation, b.rotation), std::abs(angle) * pi / 180, 1e-9);
            for (const double s : {0.25, 0.5, 0.8})
                EXPECT_LT(
                    difference(between(a, b, s).map(), Affine3d::rotate(axis, 30 + s * angle)),
                    1e-14);
        }
}

}  // namespace woodcock::test
