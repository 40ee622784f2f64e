// SPDX-License-Identifier: Apache-2.0
#include "woodcock/surface/geometry_solve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "woodcock/base/random.h"

namespace woodcock::test {

using namespace surface;

namespace {

Vec3d within(RandomStream& random, double size) {
    return Vec3d{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5} * size;
}

/// Of any shape: edges, and heights, of one unit to a millionth.
Triangle anyTriangle(RandomStream& random) {
    const auto size = [&] { return std::pow(10, -6 * random.uniform()); };
    const Vec3d corner = within(random, 1), along = within(random, size());
    const double share = 3 * random.uniform() - 1;  // below 0: a small edge opposite to the first
    const Vec3d other = share < 0 ? along : along * (share > 1 ? 0 : 2 * share - 0.5);
    return Triangle({corner, corner + along, corner + other + within(random, size())});
}

TEST(GeometrySolve, WhatIsSurelyBesideATriangleIsBeyondItsMargin) {
    RandomStream random(5);
    int sure = 0, beside = 0;
    for (int i = 0; i < 100000; ++i) {
        const Triangle triangle = anyTriangle(random);
        const double margin = std::pow(2, -40 + 30 * random.uniform());
        // Near the line of an edge, within the triangle's size or far along it; or anywhere.
        const std::size_t k = static_cast<std::size_t>(3 * random.uniform());
        const Vec3d a = triangle.corner[k], edge = triangle.corner[(k + 1) % 3] - a;
        const Vec3d across =
            normalize(cross(edge, triangle.normal)) * (4 * margin * random.uniform());
        const double kind = 3 * random.uniform();
        const Vec3d point = kind < 1   ? a + edge * (1.5 * random.uniform() - 0.25) + across
                            : kind < 2 ? a + normalize(edge) * (random.uniform() - 0.5) + across
                                       : triangle.corner[0] + within(random, 1);
        const std::array<double, 3> weights = weightsAt(triangle, point);
        const double distance = edgeDistance(triangle, weights);
        const bool surely = surelyBeside(triangle, point, margin);
        if (surely) {
            EXPECT_LT(distance, -margin) << i;
        }
        if (std::abs(weights[1]) + std::abs(weights[2]) > 15) continue;
        sure += surely, beside += distance < -2.1 * margin;
    }
    EXPECT_GT(beside, 10000);
    EXPECT_GT(sure, 0.99 * beside);
}

TEST(GeometrySolve, OnlyWeightsNearAnEdgeAreMovedAway) {
    RandomStream random(6);
    int moved = 0, kept = 0;
    for (int i = 0; i < 20000; ++i) {
        const Triangle triangle = anyTriangle(random);
        const double u = random.uniform(), v = random.uniform() * (1 - u);
        const std::array<double, 3> weights{1 - u - v, u, v};
        const double distance = edgeDistance(triangle, weights);
        if (!(distance > 1e-9)) continue;  // rounding may decide
        const double middle = edgeDistance(triangle, {1.0 / 3, 1.0 / 3, 1.0 / 3});
        const double margin = distance * std::pow(4, 2 * random.uniform() - 1);
        const std::array<double, 3> away = awayFromEdges(triangle, weights, margin);
        if (margin < distance) {
            EXPECT_EQ(away, weights);
            ++kept;
        } else if (margin > distance * 1.001 && margin < middle) {
            EXPECT_NE(away, weights);
            EXPECT_GT(edgeDistance(triangle, away), distance);
            ++moved;
        }
    }
    EXPECT_GT(moved, 5000);
    EXPECT_GT(kept, 5000);
}

TEST(GeometrySolve, RaysMeetATriangleWhereTheyAreAimed) {
    RandomStream random(7);
    for (int i = 0; i < 10000; ++i) {
        const Triangle triangle({within(random, 1), within(random, 1), within(random, 1)});
        const double u = random.uniform(), v = random.uniform() * (1 - u);
        const std::array<double, 3> weights{1 - u - v, u, v};
        const Vec3d origin = within(random, 4);
        const LocalRay ray{origin, triangle.at(weights) - origin};
        const double speed = length(ray.direction);
        const auto point = meetTriangle(ray, speed, triangle, floatError);
        ASSERT_TRUE(point) << i;
        // The errors of the oracle's own aim, seen at this angle.
        const double cosine =
            std::abs(dot(ray.direction, triangle.normal)) / (speed * length(triangle.normal));
        EXPECT_NEAR(point->t, 1, 1e-14 / cosine);
        EXPECT_NEAR(point->tolerance, floatError / cosine, 1e-12 * point->tolerance);
        EXPECT_LT(length(triangle.at(point->weights) - triangle.at(weights)), 1e-13 / cosine);
        const double aside = random.uniform() < 0.5 ? 4 : 0.25;  // of what may pass the edge
        const Vec3d along = triangle.corner[1] - triangle.corner[0];
        const Vec3d across = normalize(cross(along, triangle.normal));
        const Vec3d beside = triangle.corner[0] + along * 0.5 + across * (aside * point->tolerance);
        const LocalRay passing{beside - ray.direction, ray.direction};
        const auto other = meetTriangle(passing, speed, triangle, floatError);
        EXPECT_EQ(other.has_value(), aside < 1) << i;
        if (other) {
            EXPECT_FALSE(other->within);
        }
    }
}

}  // namespace

}  // namespace woodcock::test
