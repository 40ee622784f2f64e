// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/oracles/chandrasekhar.h"

#include <gtest/gtest.h>

#include <cmath>

#include "woodcock/base/vec.h"
#include "woodcock/proof/oracles/quadrature.h"

namespace woodcock::oracle {

using namespace oracle;

namespace {

const std::vector<double> albedos{0.01, 0.5, 0.9, 0.9999, 1 - 1e-12, 1};

TEST(ChandrasekharH, SolvesItsEquation) {
    for (const double albedo : albedos)
        for (const double mu : {1e-6, 1e-3, 0.3, 1.0}) {
            // 1 / H(mu) = sqrt(1 - a) + a / 2 times the integral of m H(m) / (mu + m)
            const double integral = tanhSinh(
                [=](double m, double) { return m * chandrasekharH(albedo, m) / (mu + m); }, 0, 1);
            EXPECT_NEAR(1 / chandrasekharH(albedo, mu),
                        std::sqrt(1 - albedo) + albedo / 2 * integral, 1e-12)
                << albedo << ' ' << mu;
        }
}

TEST(ChandrasekharH, IsOneAtGrazingAndWithoutScattering) {
    EXPECT_EQ(chandrasekharH(0.7, 0), 1);
    EXPECT_EQ(chandrasekharH(0, 0.7), 1);
    EXPECT_NEAR(chandrasekharH(1e-12, 0.7), 1, 1e-12);
    EXPECT_NEAR(chandrasekharH(1, 1e-12), 1, 1e-10);
}

// Computed with mpmath, 25 digits.
TEST(ChandrasekharH, HasThirteenDigits) {
    EXPECT_NEAR(chandrasekharH(1, 1e-3), 1.0045313977981771, 1e-13);
    EXPECT_NEAR(chandrasekharH(1, 0.1), 1.2473504424944359, 1e-13);
    EXPECT_NEAR(chandrasekharH(1, 1), 2.9078105290786057, 1e-13);
    EXPECT_NEAR(chandrasekharH(0.5, 1e-6), 1.0000035659594406, 1e-13);
    EXPECT_NEAR(chandrasekharH(0.5, 0.5), 1.1877351326704305, 1e-13);
}

// Chandrasekhar 1960, section 38: the zeroth moment is 2 / a (1 - sqrt(1 - a)), and for a = 1 the
// first is 2 / sqrt(3).
TEST(ChandrasekharMoments, AreWhatHeProved) {
    for (const double albedo : albedos)
        EXPECT_NEAR(chandrasekharMoment(albedo, 0), 2 / albedo * (1 - std::sqrt(1 - albedo)),
                    1e-12);
    EXPECT_NEAR(chandrasekharMoment(1, 1), 2 / std::sqrt(3.0), 1e-12);
}

// Hopf's own integral for his constant.
TEST(HopfConstant, IsAnIntegralWithoutH) {
    const double integral = tanhSinh(
        [](double x, double) {  // near 0 by its series, as the difference cancels
            return x < 0.1 ? 0.2 + x * x / 175 : 3 / (x * x) - 1 / (1 - x / std::tan(x));
        },
        0, pi / 2);
    EXPECT_NEAR(hopfConstant(), 6 / (pi * pi) + integral / pi, 1e-8);
}

TEST(HalfSpace, RadianceSumsUpToTheAlbedo) {
    for (const double albedo : {0.1, 0.9, 1.0})
        for (const double mu0 : {0.01, 0.4, 1.0}) {
            const double flux = tanhSinh(
                [=](double mu, double) {
                    return 2 * pi * mu * halfSpaceRadiance(albedo, mu, mu0) / mu0;
                },
                0, 1);
            EXPECT_NEAR(flux, halfSpaceAlbedo(albedo, mu0), 1e-12);
        }
}

TEST(HalfSpace, WhiteSkyAlbedoIsTheMeanOverAngles) {
    for (const double albedo : {0.1, 0.9, 0.9999, 1.0}) {
        const double mean =
            tanhSinh([=](double mu, double) { return 2 * mu * halfSpaceAlbedo(albedo, mu); }, 0, 1);
        EXPECT_NEAR(halfSpaceWhiteSkyAlbedo(albedo), mean, 1e-12);
    }
}

TEST(HalfSpace, EmitsWhatItDoesNotReflect) {
    EXPECT_EQ(halfSpaceEmissivity(0, 0.3), 1);
    EXPECT_EQ(halfSpaceEmissivity(1, 0.3), 0);
    EXPECT_NEAR(halfSpaceEmissivity(0.8, 1), std::sqrt(0.2) * 1.5982195, 1e-7);
}

// The emergent flux of Milne's problem is that of its source: the mean of H over 2 mu is 4 /
// sqrt 3.
TEST(Milne, DarkensTowardsTheLimb) {
    EXPECT_EQ(milneLimbDarkening(1), 1);
    EXPECT_NEAR(milneLimbDarkening(0), 1 / 2.90781053, 1e-9);
    const double flux =
        tanhSinh([](double mu, double) { return 2 * mu * milneLimbDarkening(mu); }, 0, 1);
    EXPECT_NEAR(flux, 4 / std::sqrt(3.0) / 2.90781053, 1e-8);
}

TEST(CaseEigenvalue, SolvesItsEquation) {
    for (const double albedo : {0.3, 0.5, 0.9, 0.99, 0.9999}) {
        const double nu = caseEigenvalue(albedo);
        EXPECT_NEAR(albedo * nu / 2 * std::log((nu + 1) / (nu - 1)), 1, 1e-11) << albedo;
    }
    EXPECT_EQ(caseEigenvalue(0), 1);
    EXPECT_EQ(caseEigenvalue(1e-12), 1);
    EXPECT_TRUE(std::isinf(caseEigenvalue(1)));
    // Nearly conservative: 3 (1 - a) nu^2 = 1 + 0.8 (1 - a), diffusion with its first correction
    const double loss = 1e-7;
    EXPECT_NEAR(caseEigenvalue(1 - loss) * std::sqrt(3 * loss), 1 + 0.4 * loss, 1e-9);
    // A little scattering: nu - 1 = 2 exp(-2 / a)
    EXPECT_NEAR((caseEigenvalue(0.1) - 1) / (2 * std::exp(-20.0)), 1, 1e-6);
}

}  // namespace
}  // namespace woodcock::oracle
