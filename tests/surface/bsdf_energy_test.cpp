// SPDX-License-Identifier: Apache-2.0
// White furnaces: what leaves a point is what came.
#include <gtest/gtest.h>

#include "tests/support/expect_mean.h"
#include "tests/surface/one_bsdf.h"
#include "woodcock/base/statistics.h"
#include "woodcock/surface/fresnel.h"

namespace woodcock::test {

using namespace surface;

namespace {

constexpr double cosines[] = {1, 0.9, 0.5, 0.1, 0.01, 1.745e-4, 1e-8};  // 1.745e-4: 89.99 degrees

/// Reflectance and transmittance of light from all around: weights without the change of radiance
/// that comes with the index of refraction.
struct Shares {
    Moments reflected, transmitted, all;
};

Shares sharesOf(const Bsdf& bsdf, Vec3d out, double squeeze, int n, std::uint64_t seed) {
    RandomStream random(seed);
    Shares shares;
    for (int i = 0; i < n; ++i) {
        const BsdfSample s = bsdf.sample(out, three(random));
        const double weight = double{s.weight[0]} * (s.transmitted ? squeeze : 1);
        EXPECT_TRUE(weight >= 0 && weight <= 1 + 2e-7) << weight;
        shares.reflected.add(s.transmitted ? 0 : weight);
        shares.transmitted.add(s.transmitted ? weight : 0);
        shares.all.add(weight);
    }
    return shares;
}

TEST(BsdfEnergy, WhiteDiffuseAndMirrorsLoseNothing) {
    for (const double cosine : cosines)
        for (const Material& material : {diffuse(1), whiteMetal(0)}) {
            RandomStream random(1);
            for (int i = 0; i < 1000; ++i) {
                const BsdfSample s = bsdfOf(material).sample(at(cosine, 1), three(random));
                EXPECT_EQ(s.weight, Rgb(1.0f));
            }
        }
}

TEST(BsdfEnergy, SmoothGlassLosesNothingAndSplitsByFresnel) {
    for (const double eta : {1.0001, 1.33, 1.5, 3.0, 1 / 1.5, 1 / 3.0})
        for (const double cosine : cosines) {
            const Bsdf bsdf = bsdfOf(glass(0), flatPoint(1, eta));
            const double reflectance = refraction(cosine, eta).reflectance;
            int reflected = 0;
            constexpr int n = 1000;
            for (int i = 0; i < n; ++i) {
                const BsdfSample s = bsdf.sample(at(cosine, 1), {(i + 0.5) / n, 0.5, 0.5});
                const double squeeze = s.transmitted ? eta * eta : 1;
                ASSERT_TRUE(s.delta);
                EXPECT_EQ(s.weight[0], static_cast<float>(1 / squeeze));
                EXPECT_EQ(s.direction.z < 0, s.transmitted);
                reflected += !s.transmitted;
            }
            EXPECT_NEAR(reflected, reflectance * n, 0.5001) << eta << " " << cosine;
        }
}

TEST(BsdfEnergy, TotalReflectionIsExact) {
    for (const double ior : {1.0001, 1.33, 1.5, 3.0})
        for (const double roughness : {0.0, 0.01}) {
            const Bsdf bsdf = bsdfOf(glass(roughness), flatPoint(1, ior));
            const double critical = std::sqrt(1 - 1 / (ior * ior));
            for (const double u : {0.0, 0.5, 1 - 0x1p-53}) {
                const BsdfSample s = bsdf.sample(-at(critical * (1 - 1e-9), 1), {u, 0.5, 0.5});
                EXPECT_FALSE(s.transmitted);
                EXPECT_EQ(s.weight, Rgb(1.0f));
                EXPECT_LT(s.direction.z, 0);
            }
            EXPECT_TRUE(
                bsdf.sample(-at(critical * (1 + 1e-4), 1), {1 - 0x1p-53, 0.5, 0.5}).transmitted);
        }
}

TEST(BsdfEnergy, RoughFacetsCreateNone) {
    for (const double roughness : {0.03, 0.1, 0.3, 0.5, 0.7, 1.0})
        for (const double cosine : cosines) {
            const Shares metal = sharesOf(bsdfOf(whiteMetal(roughness)), at(cosine, 1), 1, 2000, 1);
            EXPECT_LE(metal.all.mean(), 1.0 + 1e-7) << roughness << " " << cosine;
            for (const double eta : {1.0001, 1.5, 3.0, 1 / 1.5, 1 / 3.0}) {
                const Shares shares = sharesOf(bsdfOf(glass(roughness), flatPoint(1, eta)),
                                               at(cosine, 1), eta * eta, 2000, 2);
                EXPECT_LE(shares.all.mean(), 1.0 + 1e-7)
                    << roughness << " " << cosine << " " << eta;
            }
        }
}

/// With D = 1 / pi (alpha = 1) and light along the normal, c^2 of facets is even and what leaves
/// unhidden is 2 - 1 / c^2 of it from c^2 = 1/2 on, where it leaves at all: 1 - ln 2 in all.
TEST(BsdfEnergy, OfTheRoughestMetalThatIsScatteredOnceIsKnown) {
    EXPECT_NEAR(facetEnergy(1, 0).outside.lost(1), std::log(2.0), 1e-4);
}

TEST(BsdfEnergy, OfBarelyRoughMatterIsThatOfSmooth) {
    for (const double eta : {1.5, 1 / 1.5})
        for (const double cosine : {1.0, 0.8}) {
            const Shares shares = sharesOf(bsdfOf(glass(0.03), flatPoint(1, eta)), at(cosine, 1),
                                           eta * eta, 100000, 4);
            const double reflectance = refraction(cosine, eta).reflectance;
            EXPECT_NEAR(shares.reflected.mean(), reflectance,
                        4 * shares.reflected.standardError() + 1e-4);
            EXPECT_NEAR(shares.transmitted.mean(), 1 - reflectance,
                        4 * shares.transmitted.standardError() + 1e-4);
        }
}

constexpr double roughnesses[] = {0.05, 0.2, 0.3, 0.5, 0.7, 1.0};
constexpr double etas[] = {1.33, 1.5, 2.4, 1 / 1.33, 1 / 1.5, 1 / 2.4};

/// Every sample brings all light there is, whichever side it comes from.
TEST(BsdfEnergy, RoughWhiteMetalAndGlassLoseNothing) {
    const auto losesNothing = [](const Bsdf& bsdf, double cosine, double squeeze) {
        RandomStream random(6);
        for (int i = 0; i < 1000; ++i) {
            const BsdfSample s = bsdf.sample(at(cosine, 1), three(random));
            ASSERT_NEAR(double{s.weight[0]} * (s.transmitted ? squeeze : 1), 1, 2e-6) << cosine;
        }
    };
    for (const double roughness : roughnesses)
        for (const double cosine : cosines) {
            losesNothing(bsdfOf(whiteMetal(roughness)), cosine, 1);
            for (const double eta : etas)
                losesNothing(bsdfOf(glass(roughness), flatPoint(1, eta)), cosine, eta * eta);
        }
}

/// The same of what evaluate() says, which light that is looked for relies on: over the sphere,
/// finely around the direction straight on, so that nothing of sample() has a part in it.
TEST(BsdfEnergy, EvaluatesToAllLight) {
    constexpr int rows = 800, columns = 400;
    const auto sumOf = [](const Bsdf& bsdf, Vec3d out, double squeeze) {
        const Vec3d axis = -out;
        Vec3d s, t;
        orthonormalBasis(axis, s, t);
        double sum = 0;
        for (int i = 0; i < rows; ++i) {
            const double place = (i + 0.5) / rows, angle = pi * place * place;
            const double area = std::sin(angle) * 2 * pi * place / rows * 2 * pi / columns;
            for (int j = 0; j < columns; ++j) {
                const double phi = 2 * pi * (j + 0.5) / columns;
                const Vec3d in = axis * std::cos(angle) +
                                 (s * std::cos(phi) + t * std::sin(phi)) * std::sin(angle);
                sum += double{bsdf.evaluate(out, in)[0]} * area * (in.z * out.z < 0 ? squeeze : 1);
            }
        }
        return sum;
    };
    for (const double roughness : {0.5, 0.7, 1.0})
        for (const double cosine : {1.0, 0.6, 0.2}) {
            EXPECT_NEAR(sumOf(bsdfOf(whiteMetal(roughness)), at(cosine, 1), 1), 1, 1e-3)
                << roughness << " " << cosine;
            for (const double eta : {1.33, 1.5, 1 / 1.5, 1 / 2.4})
                EXPECT_NEAR(
                    sumOf(bsdfOf(glass(roughness), flatPoint(1, eta)), at(cosine, 1), eta * eta), 1,
                    1e-3)
                    << roughness << " " << cosine << " " << eta;
        }
}

/// Directions are drawn as their density says.
TEST(FacetLosses, SampleTheirDensity) {
    const FacetLosses& losses = facetEnergy(0.49, 1.5).inside;
    RandomStream random(8);
    Moments cosine;
    for (int i = 0; i < 200000; ++i) cosine.add(losses.sampleCosine(random.uniform()));
    double mean = 0, all = 0;
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
        const double mu = (i + 0.5) / n;
        all += 2 * pi * losses.density(mu) / n, mean += 2 * pi * losses.density(mu) * mu / n;
    }
    EXPECT_NEAR(all, 1, 1e-5);
    EXPECT_NEAR(cosine.mean(), mean, 4 * cosine.standardError());
}

}  // namespace
}  // namespace woodcock::test
