// SPDX-License-Identifier: Apache-2.0
#include "woodcock/surface/fresnel.h"

#include <gtest/gtest.h>

#include <complex>

#include "woodcock/base/random.h"
#include "woodcock/base/vec.h"

namespace woodcock::test {

using namespace surface;

namespace {

using Complex = std::complex<double>;

/// Of s- and p-polarised light: Born and Wolf 1999, eq. 1.5 (21), with complex angles.
std::array<double, 2> polarised(double cosine, Complex eta) {
    const Complex beyond = std::sqrt(1.0 - (1 - cosine * cosine) / (eta * eta));
    return {std::norm((cosine - eta * beyond) / (cosine + eta * beyond)),
            std::norm((eta * cosine - beyond) / (eta * cosine + beyond))};
}

double unpolarised(double cosine, Complex eta) {
    const auto [s, p] = polarised(cosine, eta);
    return (s + p) / 2;
}

TEST(Fresnel, IsKnownAtNormalIncidence) {
    for (const double eta : {1.0001, 1.33, 1.5, 2.42, 3.0, 1 / 1.5, 1 / 3.0})
        EXPECT_NEAR(refraction(1, eta).reflectance, std::pow((eta - 1) / (eta + 1), 2), 1e-16);
    EXPECT_NEAR(refraction(1, 1.5).reflectance, 0.04, 1e-16);
    EXPECT_EQ(refraction(1, 1.5).cosine, 1);
}

TEST(Fresnel, LosesOnePolarisationAtBrewstersAngle) {
    for (const double eta : {1.1, 1.5, 2.42, 1 / 1.5}) {
        const double cosine = std::cos(std::atan(eta));
        EXPECT_NEAR(refraction(cosine, eta).reflectance, polarised(cosine, eta)[0] / 2, 1e-15);
    }
    EXPECT_NEAR(refraction(std::cos(std::atan(1.5)), 1.5).reflectance, 0.0739644970414201, 1e-14);
}

TEST(Fresnel, ReflectsAllAtGrazingIncidence) {
    EXPECT_EQ(refraction(0, 1.5).reflectance, 1);
    for (const double cosine : {1e-3, 1e-8, 1e-16}) {
        // ((1 - x) / (1 + x))^2 = 1 - 4 x + 8 x^2 ..., for x_s = cos / sqrt(n^2 - 1) and
        // x_p = n^2 x_s.
        const double s = cosine / std::sqrt(1.25), p = 2.25 * s;
        const double lost = 1 - refraction(cosine, 1.5).reflectance;
        EXPECT_NEAR(lost, 2 * (s + p), 4 * (s * s + p * p) + 4e-16);
        EXPECT_LE(refraction(cosine, 1.5).reflectance, 1);
    }
}

TEST(Fresnel, ReflectsAllBeyondTheCriticalAngleExactly) {
    for (const double ior : {1.0001, 1.33, 1.5, 3.0}) {
        const double critical = std::sqrt(1 - 1 / (ior * ior));
        for (const double below : {1e-12, 1e-6, 1e-3, 0.5, 1.0}) {
            const Refraction r = refraction(critical * (1 - below), 1 / ior);
            EXPECT_EQ(r.reflectance, 1) << ior << " " << below;
            EXPECT_EQ(r.cosine, 0);
        }
        EXPECT_LT(refraction(critical * (1 + 1e-9), 1 / ior).reflectance, 1);
    }
}

TEST(Fresnel, IsTheSameFromBothSides) {
    RandomStream random(1);
    for (int i = 0; i < 10000; ++i) {
        const double cosine = random.uniformOpenLow(), eta = 1 + 2 * random.uniformOpenLow();
        const Refraction in = refraction(cosine, eta), back = refraction(in.cosine, 1 / eta);
        EXPECT_NEAR(back.reflectance, in.reflectance, 1e-12 / cosine);
        EXPECT_NEAR(back.cosine, cosine, 1e-14 / cosine);
    }
}

TEST(Fresnel, ReflectsNothingBetweenEqualIndices) {
    for (const double cosine : {1.0, 0.5, 1e-3})
        EXPECT_NEAR(refraction(cosine, 1).reflectance, 0, 1e-20);
}

TEST(ConductorFresnel, WithoutAbsorptionIsADielectric) {
    RandomStream random(2);
    for (int i = 0; i < 10000; ++i) {
        const double cosine = random.uniform(), eta = 0.3 + 2.7 * random.uniform();
        EXPECT_NEAR(conductorReflectance(cosine, eta, 0), refraction(cosine, eta).reflectance, 1e-6)
            << cosine << " " << eta;
    }
}

TEST(ConductorFresnel, IsThatOfComplexNumbers) {
    RandomStream random(3);
    for (int i = 0; i < 10000; ++i) {
        const double cosine = random.uniformOpenLow();
        const double eta = 0.05 + 5 * random.uniform(), k = 0.1 + 8 * random.uniform();
        EXPECT_NEAR(conductorReflectance(cosine, eta, k), unpolarised(cosine, {eta, k}), 1e-12);
    }
}

TEST(ConductorFresnel, IsPublishedForGoldAndCopper) {
    // n and k at 650, 550 and 450 nm of Johnson and Christy 1972, averaged over the sensitivities
    // of R, G and B; reflectances: Akenine-Moeller et al. 2018, "Real-Time Rendering", table 9.2.
    const auto reflectance = [](Rgb eta, Rgb k) {
        return Rgb::map([&](int c) {
            return static_cast<float>(conductorReflectance(1, double{eta[c]}, double{k[c]}));
        });
    };
    const Rgb gold = reflectance({0.143f, 0.375f, 1.442f}, {3.983f, 2.386f, 1.603f});
    const Rgb copper = reflectance({0.200f, 0.924f, 1.102f}, {3.912f, 2.452f, 2.142f});
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(gold[c], (Rgb{1.0f, 0.782f, 0.344f})[c], 0.04) << c;
        EXPECT_NEAR(copper[c], (Rgb{0.955f, 0.638f, 0.538f})[c], 0.04) << c;
    }
}

TEST(ConductorFresnel, StaysWithinBoundsAtTheExtremes) {
    for (const double cosine : {0.0, 1e-300, 1e-16, 1e-8, 0.5, 1 - 1e-16, 1.0, 1 + 1e-15})
        for (const double eta : {0.0, 1e-8, 1.0, 1.5, 100.0})
            for (const double k : {0.0, 1e-8, 1.0, 100.0}) {
                const double r = conductorReflectance(cosine, eta, k);
                EXPECT_TRUE(r >= 0 && r <= 1) << r << " " << cosine << " " << eta << " " << k;
            }
    EXPECT_EQ(conductorReflectance(0, 0.2, 3), 1);
}

TEST(Schlick, MeetsBothEnds) {
    const Rgb colour(0.9f, 0.5f, 0);
    EXPECT_EQ(schlickReflectance(1, colour), colour);
    EXPECT_EQ(schlickReflectance(0, colour), Rgb(1.0f));
    EXPECT_EQ(schlickReflectance(1 + 1e-15, colour), colour);
    EXPECT_NEAR(schlickReflectance(0.5, colour)[1], 0.5 + 0.5 / 32, 1e-7);
}

}  // namespace
}  // namespace woodcock::test
