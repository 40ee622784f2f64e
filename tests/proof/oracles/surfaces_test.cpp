// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/oracles/surfaces.h"

#include <gtest/gtest.h>

#include "woodcock/proof/oracles/chandrasekhar.h"
#include "woodcock/proof/oracles/plates.h"
#include "woodcock/proof/oracles/quadrature.h"

namespace woodcock::oracle {

using namespace oracle;

namespace {

/// Irradiance from the parallelogram, by the definition: cos cos' / distance^2 over its area.
double parallelogramBySum(Vec3d corner, Vec3d u, Vec3d v, Vec3d point, Vec3d normal) {
    constexpr int n = 800;
    const Vec3d area = cross(u, v) / double{n} / double{n};
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const Vec3d d = corner + u * ((i + 0.5) / n) + v * ((j + 0.5) / n) - point;
            const double d2 = dot(d, d);
            sum += std::max(0.0, dot(d, normal)) * std::abs(dot(d, area)) / (d2 * d2);
        }
    return sum;
}

TEST(PolygonIrradiance, IsTheIntegralOverItsArea) {
    const Vec3d corner{-0.3, -1, 1}, u{2, 0.1, 0.4}, v{-0.2, 1.5, -0.1};
    const std::vector<Vec3d> corners{corner, corner + u, corner + u + v, corner + v};
    for (const Vec3d normal : {Vec3d{0, 0, 1}, Vec3d{1, 2, 2}, Vec3d{-2, 1, 0.2}, Vec3d{1, 0, 0}}) {
        const Vec3d n = normalize(normal);
        for (const Vec3d point : {Vec3d{}, Vec3d{0.5, 0.2, 0.3}, Vec3d{-3, 1, 0}}) {
            const double sum = parallelogramBySum(corner, u, v, point, n);
            EXPECT_NEAR(polygonIrradiance(corners, point, n), sum, 2e-6);
            EXPECT_NEAR(polygonIrradiance({corners.rbegin(), corners.rend()}, point, n), sum, 2e-6);
        }
    }
}

TEST(PolygonIrradiance, OfRectanglesIsHowells) {
    const double x = 1.5, y = 0.7;
    const double p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
    // A parallel rectangle, from below its corner (C-11)
    EXPECT_NEAR(polygonIrradiance({{0, 0, 1}, {x, 0, 1}, {x, y, 1}, {0, y, 1}}, {}, {0, 0, 1}),
                (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / 2, 1e-15);
    // One that stands on the plane, as wide as 1 and as high as x, at y from a point that faces its
    // lower corner (C-12)
    const double r = std::sqrt(x * x + y * y);
    EXPECT_NEAR(polygonIrradiance({{0, y, 0}, {1, y, 0}, {1, y, x}, {0, y, x}}, {}, {0, 0, 1}),
                (std::atan(1 / y) - y / r * std::atan(1 / r)) / 2, 1e-15);
}

TEST(PolygonIrradiance, IsPiInAllDirectionsUnderARoof) {
    const std::vector<Vec3d> roof{{-1e8, -1e8, 1}, {1e8, -1e8, 1}, {1e8, 1e8, 1}, {-1e8, 1e8, 1}};
    EXPECT_NEAR(polygonIrradiance(roof, {}, {0, 0, 1}), pi, 1e-7);
    EXPECT_NEAR(polygonIrradiance(roof, {}, {1, 0, 0}), pi / 2, 1e-7);  // half of it is below
    EXPECT_EQ(polygonIrradiance(roof, {}, {0, 0, -1}), 0);
}

TEST(DiskIrradiance, IsThatOfManySidedPolygons) {
    constexpr int sides = 20000;
    for (const double height : {0.01, 1.0, 30.0})
        for (const double offset : {0.0, 0.5, 0.99, 1.5, 40.0}) {
            std::vector<Vec3d> corners;
            for (int i = 0; i < sides; ++i) {
                const double phi = 2 * pi * i / sides;
                corners.push_back({offset + std::cos(phi), std::sin(phi), height});
            }
            const double polygon = polygonIrradiance(corners, {}, {0, 0, 1});
            // Edge by edge, a polygon that is all but edge-on has only its first digits.
            EXPECT_NEAR(diskIrradiance(1, height, offset), polygon, 1e-6 * polygon + 1e-15)
                << height << ' ' << offset;
        }
}

TEST(DiskIrradiance, AtItsLimits) {
    EXPECT_NEAR(diskIrradiance(2, 3, 0), pi * 4 / 13, 1e-15);
    EXPECT_NEAR(diskIrradiance(1, 1e-9, 0.5), pi, 1e-8);
    EXPECT_NEAR(diskIrradiance(1, 1e-9, 1), pi / 2, 1e-8);
    EXPECT_NEAR(diskIrradiance(1e-4, 1e5, 0) / (pi * 1e-18), 1, 1e-14);
    EXPECT_NEAR(diskIrradiance(1, 1e6, 1e6) / (pi / 4 * 1e-12), 1, 1e-11);
}

TEST(SphereIrradiance, IsTheIntegralOverItsCone) {
    constexpr int n = 1000;
    for (const double distance : {1.0, 1.1, 2.0, 10.0})
        for (const double cosine : {1.0, 0.7, 0.3, 0.0, -0.05, -0.4, -1.0}) {
            const double sine = std::sqrt(1 - cosine * cosine);
            const double top = std::sqrt(1 - 1 / (distance * distance));
            double sum = 0;
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    const double z = 1 - (i + 0.5) / n * (1 - top), out = std::sqrt(1 - z * z);
                    const double up = cosine * z + sine * out * std::cos(pi * (j + 0.5) / n);
                    sum += std::max(0.0, up) * 2 * pi * (1 - top) / n / n;
                }
            EXPECT_NEAR(sphereIrradiance(3, 3 * distance, cosine), sum, 1e-5)
                << distance << ' ' << cosine;
        }
}

TEST(SphereIrradiance, AtItsLimits) {
    EXPECT_NEAR(sphereIrradiance(1, 2, 1), pi / 4, 1e-15);
    EXPECT_NEAR(sphereIrradiance(1, 1e5, 0.5) / (pi / 2 * 1e-10), 1, 1e-14);
    EXPECT_NEAR(sphereIrradiance(1, 1, 0), pi / 2, 1e-15);  // touched by the plane
    EXPECT_NEAR(sphereIrradiance(1, 1, 1), pi, 1e-15);
}

// Light in equilibrium: as much enters a face as leaves it.
TEST(Enclosures, RadianceInADielectricBalances) {
    for (const double index : {1.0, 1.33, 1.5, 2.4}) {
        const auto passing = [](double from, double to) {
            return [=](double mu, double) {
                return 2 * mu * (1 - fresnelReflectances(mu, from, to).mean());
            };
        };
        const double critical = std::sqrt(1 - 1 / (index * index));
        const double entering = tanhSinh(passing(1, index), 0, 1);
        const double leaving = tanhSinh(passing(index, 1), critical, 1);
        EXPECT_NEAR(radianceInDielectric(index), entering / leaving, 1e-7);
    }
}

TEST(Enclosures, CavitiesAddTheirReflections) {
    EXPECT_DOUBLE_EQ(cavityRadiance(3, 0), 3);
    EXPECT_DOUBLE_EQ(cavityRadiance(1, 0.75), 4);
    double sum = 0;
    for (int reflections = 0; reflections < 40; ++reflections) {
        sum += 2 * std::pow(0.75, reflections);
        EXPECT_NEAR(cavityRadiance(2, 0.75, reflections), sum, 1e-13);
    }
}

TEST(RefractiveHalfSpace, IsGiovanellis) {
    EXPECT_NEAR(refractiveHalfSpaceReflectance(1.5, 0.9, 0, 1), 0.2600, 1e-4);
    for (const double mu : {1.0, 0.5, 0.1})
        EXPECT_NEAR(refractiveHalfSpaceReflectance(1, 0.9, 0, mu), halfSpaceAlbedo(0.9, mu), 1e-7);
    // Of black matter the boundary alone is left.
    EXPECT_NEAR(refractiveHalfSpaceReflectance(1.33, 0, 0.5, 0.5),
                fresnelReflectances(0.5, 1, 1.33).mean(), 1e-14);
}

}  // namespace
}  // namespace woodcock::oracle
