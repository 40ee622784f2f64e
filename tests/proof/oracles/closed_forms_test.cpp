// SPDX-License-Identifier: Apache-2.0
// Each closed form against an integral that knows only the definition, and at its extremes.
#include "woodcock/proof/oracles/closed_forms.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "woodcock/base/vec.h"
#include "woodcock/proof/oracles/quadrature.h"

namespace woodcock::oracle {

using namespace oracle;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Integral of f over [a, b] by Gauss-Legendre in many equal parts: plain, for smooth f.
template <class F>
double integral(F f, double a, double b, int parts = 200) {
    static const Quadrature rule = gaussLegendre(16);
    double sum = 0;
    const double width = (b - a) / parts;
    for (int part = 0; part < parts; ++part)
        for (std::size_t i = 0; i < rule.nodes.size(); ++i)
            sum += rule.weights[i] * width * f(a + (part + rule.nodes[i]) * width);
    return sum;
}

TEST(ClosedForms, SlabTransmittance) {
    EXPECT_DOUBLE_EQ(slabTransmittance(2, 0.5), std::exp(-4.0));
    EXPECT_EQ(slabTransmittance(0, 0.1), 1);
    EXPECT_EQ(slabTransmittance(1e8, 1), 0);
    EXPECT_DOUBLE_EQ(1 - slabTransmittance(1e-10, 1), 1 - std::exp(-1e-10));
}

TEST(ClosedForms, EmittedRadiance) {
    EXPECT_NEAR(emittedRadiance(1, 1, 0.1), 0.09516258, 5e-9);
    EXPECT_NEAR(emittedRadiance(1, 1, 1), 0.63212056, 5e-9);
    EXPECT_NEAR(emittedRadiance(1, 1, 5), 0.99326205, 5e-9);
    for (const double absorption : {1e-3, 0.7, 4.0}) {
        const double sum = integral([=](double t) { return 3 * std::exp(-absorption * t); }, 0, 2);
        EXPECT_NEAR(emittedRadiance(3, absorption, 2) / sum, 1, 1e-13);
    }
    EXPECT_EQ(emittedRadiance(3, 0, 2), 6);
    EXPECT_DOUBLE_EQ(emittedRadiance(3, 1e-300, 2), 6);
    EXPECT_DOUBLE_EQ(emittedRadiance(3, 1e-10, 2), 6 * (1 - 1e-10));
    EXPECT_EQ(emittedRadiance(3, 1e8, 2), 3e-8);
    EXPECT_EQ(emittedRadiance(3, 2, infinity), 1.5);
}

TEST(ClosedForms, SphereDiscTransmittance) {
    EXPECT_NEAR(sphereDiscTransmittance(0.5), 0.52848224, 5e-9);
    EXPECT_NEAR(sphereDiscTransmittance(1), 0.29699708, 5e-9);
    EXPECT_NEAR(sphereDiscTransmittance(2), 0.11355273, 5e-9);
    EXPECT_NEAR(sphereDiscTransmittance(5), 0.01999001, 5e-9);
    for (const double T : {1e-3, 0.2, 0.499, 0.501, 3.0, 20.0}) {
        // Chords of half-length c are c dc of the disc's 1/2.
        const double mean = integral([=](double c) { return 2 * c * std::exp(-2 * T * c); }, 0, 1);
        EXPECT_NEAR(sphereDiscTransmittance(T) / mean, 1, 1e-13) << T;
    }
    EXPECT_EQ(sphereDiscTransmittance(0), 1);
    EXPECT_NEAR(1 - sphereDiscTransmittance(1e-10), 4e-10 / 3, 1e-15);
    EXPECT_DOUBLE_EQ(sphereDiscTransmittance(1e8), 0.5e-16);
}

TEST(ClosedForms, GaussianBall) {
    const double sigma = 3, s = 0.4;
    for (const double b : {0.0, 0.3, 2.0}) {
        const double sum = integral(
            [=](double t) { return sigma * std::exp(-(t * t + b * b) / (2 * s * s)); }, -8, 8);
        EXPECT_NEAR(gaussianBallOpticalDepth(sigma, s, b) / sum, 1, 1e-13);
    }
}

TEST(ClosedForms, ExponentialAtmosphere) {
    const double sigma = 0.2, scaleHeight = 8, mu = 0.3;
    const auto sum = [&](double bottom, double top) {
        return integral(
            [=](double t) { return sigma * std::exp(-(bottom + mu * t) / scaleHeight); }, 0,
            (top - bottom) / mu);
    };
    EXPECT_NEAR(exponentialAtmosphereOpticalDepth(sigma, scaleHeight, 1, 5, mu), sum(1, 5), 1e-13);
    EXPECT_NEAR(exponentialAtmosphereOpticalDepth(sigma, scaleHeight, 0, infinity, mu), sum(0, 400),
                1e-12);
    EXPECT_DOUBLE_EQ(exponentialAtmosphereOpticalDepth(sigma, scaleHeight, 0, infinity, mu),
                     sigma * scaleHeight / mu);
    EXPECT_DOUBLE_EQ(exponentialAtmosphereOpticalDepth(1, 1e10, 0, 1, 1), 1 - 0.5e-10);
}

TEST(ClosedForms, Ramp) {
    const double sum = integral([](double t) { return 1 + (4 - 1) * t / 7; }, 0, 7);
    EXPECT_NEAR(rampOpticalDepth(1, 4, 7), sum, 1e-13);
}

TEST(ClosedForms, SingleScattering) {
    const double albedo = 0.8, phase = 0.3;
    for (const double depth : {1e-6, 0.5, 3.0})
        for (const double mu0 : {1.0, 0.5, 0.2})
            for (const double mu : {1.0, 0.5000001, 0.5, 0.1}) {
                // Light scattered at each depth z, from the beam's irradiance on a plane, mu0
                const auto scattered = [&](double wayOut, double z) {
                    return albedo * phase * std::exp(-z / mu0 - wayOut / mu) / mu;
                };
                const double back = integral([&](double z) { return scattered(z, z); }, 0, depth);
                const double forth =
                    integral([&](double z) { return scattered(depth - z, z); }, 0, depth);
                EXPECT_NEAR(singleScatterReflected(depth, albedo, phase, mu, mu0) / back, 1, 1e-12);
                EXPECT_NEAR(singleScatterTransmitted(depth, albedo, phase, mu, mu0) / forth, 1,
                            1e-12);
            }
}

TEST(ClosedForms, SingleScatteringAtTheExtremes) {
    for (const double mu : {1.0, 0.5, 1e-3}) {
        EXPECT_EQ(singleScatterReflected(0, 1, 1, mu, 0.5), 0);
        EXPECT_EQ(singleScatterTransmitted(0, 1, 1, mu, 0.5), 0);
        EXPECT_DOUBLE_EQ(singleScatterReflected(1e8, 1, 1, mu, 0.5), 0.5 / (mu + 0.5));
        EXPECT_EQ(singleScatterTransmitted(1e8, 1, 1, mu, 0.5), 0);
        EXPECT_NEAR(singleScatterReflected(1e-15, 1, 1, mu, 0.5) * mu * 1e15, 1, 1e-11);
        EXPECT_NEAR(singleScatterTransmitted(1e-15, 1, 1, mu, 0.5) * mu * 1e15, 1, 1e-11);
    }
    EXPECT_DOUBLE_EQ(singleScatterTransmitted(2, 1, 1, 0.5, 0.5), 4 * std::exp(-4.0));
}

TEST(ClosedForms, HalfSpaceFirstOrder) {
    for (const double mu0 : {1.0, 0.3, 0.01}) {
        const double flux = tanhSinh(
            [=](double mu, double) {
                return 2 * pi * mu / mu0 * singleScatterReflected(1e8, 0.7, 1 / (4 * pi), mu, mu0);
            },
            0, 1);
        EXPECT_NEAR(halfSpaceFirstOrderAlbedo(0.7, mu0), flux, 1e-13);
    }
    EXPECT_EQ(halfSpaceFirstOrderAlbedo(0.7, 0), 0.35);
    const double mean = tanhSinh(
        [](double mu, double) { return 2 * mu * halfSpaceFirstOrderAlbedo(0.7, mu); }, 0, 1);
    EXPECT_NEAR(halfSpaceFirstOrderWhiteSkyAlbedo(0.7), mean, 1e-13);
}

TEST(ClosedForms, Airlight) {
    for (const Airlight& a : {Airlight{0.1, 0.4, 0, 5, 1},
                              {0, 0.02, 0.8, 5, 0.3},
                              {1, 3, -0.6, 2, 0.5},
                              {0, 1e-12, 0.5, 1, 2},
                              {20, 80, 0.9, 1, 2}}) {
        const double eye = -2, from = -1.5, to = 3, sigma = a.absorption + a.scattering;
        // From positions alone: the eye and the sight are on the x axis, the light above 0.
        const double sum = integral(
            [&](double x) {
                const double distance = std::hypot(x, a.offset);
                const double cosine = -x / distance;  // of light from (0, h) that leaves along -x
                return a.scattering * a.intensity * henyeyGreenstein(cosine, a.g) *
                       std::exp(-sigma * (x - eye + distance)) / (distance * distance);
            },
            from, to, 2000);
        EXPECT_NEAR(airlight(a, eye, from, to) / sum, 1, 1e-10);
    }
    // Without extinction, isotropic, all along the line: half the turn around the light
    EXPECT_NEAR(airlight({0, 1e-20, 0, 1, 2}, -1e9, -1e9, infinity) / (1e-20 / 2 / 4), 1, 1e-8);
    // Close to the light: the same, but for the way to the eye
    const Airlight near{0, 1, 0, 1, 1e-8};
    EXPECT_NEAR(airlight(near, -1, -1, 1) / (std::exp(-1.0) / (4e-8)), 1, 1e-6);
}

TEST(ClosedForms, InfiniteMedium) {
    EXPECT_EQ(meanCollisionCount(0), 1);
    EXPECT_DOUBLE_EQ(meanCollisionCount(0.75), 4);
    EXPECT_NEAR(meanSquareDistance(10, 0.5), 36.0039, 5e-5);
    EXPECT_NEAR(meanSquareDistance(10, 0.9), 82.7621, 5e-5);
    const auto closedForm = [](int n, double g) {
        return 2 * (n / (1 - g) - g * (1 - std::pow(g, n)) / ((1 - g) * (1 - g)));
    };
    for (const double g : {-0.9, 0.0, 0.3, 0.95})
        for (const int n : {1, 2, 17, 1000})
            EXPECT_NEAR(meanSquareDistance(n, g) / closedForm(n, g), 1, 1e-12) << n << ' ' << g;
    // Straight on: the square of a sum of n exponential lengths, n (n + 1)
    EXPECT_NEAR(meanSquareDistance(100, 1 - 1e-12), 100 * 101, 1e-5);
}

TEST(ClosedForms, MeanChords) {
    EXPECT_DOUBLE_EQ(cubeMeanChord(3), meanChord(27, 54));
    EXPECT_DOUBLE_EQ(sphereMeanChord(3), meanChord(4 * pi / 3 * 27, 4 * pi * 9));
    EXPECT_DOUBLE_EQ(slabMeanChord(3), meanChord(3e10, 2e10));
    // From the definition: chords of a sphere and a slab, entered by the cosine law.
    const auto overAngles = [](auto chord) {
        return integral([=](double mu) { return 2 * mu * chord(mu); }, 0, 1);
    };
    EXPECT_NEAR(sphereMeanChord(3), overAngles([](double mu) { return 2 * 3 * mu; }), 1e-13);
    EXPECT_NEAR(slabMeanChord(3), overAngles([](double mu) { return 3 / mu; }), 1e-13);
}

TEST(HenyeyGreenstein, IntegratesToOneWithMeanCosineG) {
    for (const double g : {0.0, 1e-7, -1e-3, 0.5, -0.99, 0.9999}) {
        const auto over = [=](auto f) {
            return tanhSinh(
                [=](double c, double) { return 2 * pi * henyeyGreenstein(c, g) * f(c); }, -1, 1);
        };
        EXPECT_NEAR(over([](double) { return 1.0; }), 1, 1e-9) << g;
        EXPECT_NEAR(over([](double c) { return c; }), g, 1e-9) << g;
    }
}

TEST(HenyeyGreenstein, IsTheTextbooksFormula) {
    for (const double g : {0.3, -0.3, 0.9, -0.9})
        for (const double c : {-1.0, -0.4, 0.7, 1.0}) {
            const double textbook = (1 - g * g) / (4 * pi * std::pow(1 + g * g - 2 * g * c, 1.5));
            EXPECT_NEAR(henyeyGreenstein(c, g) / textbook, 1, 1e-12);
        }
    EXPECT_EQ(henyeyGreenstein(0.3, 0), 1 / (4 * pi));
    const double g = 1 - 1e-9;
    EXPECT_NEAR(henyeyGreenstein(1, g) * 4 * pi * 1e-18 / 2, 1, 1e-6);
}

TEST(HenyeyGreenstein, CdfIsTheIntegral) {
    for (const double g : {0.0, 1e-7, -1e-3, 0.5, -0.9, 0.99})
        for (const double c : {-0.99, 0.0, 0.5, 0.999}) {
            const double sum =
                integral([=](double x) { return 2 * pi * henyeyGreenstein(x, g); }, -1, c, 5000);
            EXPECT_NEAR(henyeyGreensteinCdf(c, g), sum, 1e-12) << g << ' ' << c;
        }
    for (const double g : {0.0, 1e-300, 0.5, -0.5, 1 - 1e-9, -1 + 1e-9}) {
        EXPECT_EQ(henyeyGreensteinCdf(-1, g), 0) << g;
        EXPECT_NEAR(henyeyGreensteinCdf(1, g), 1, 1e-15) << g;
    }
}

}  // namespace
}  // namespace woodcock::oracle
