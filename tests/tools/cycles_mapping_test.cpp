// SPDX-License-Identifier: Apache-2.0
#include "tools/cycles/mapping.h"

#include <gtest/gtest.h>

#include "woodcock/base/random.h"
#include "woodcock/scene/build.h"

namespace woodcock::test {

using namespace scene;
using namespace tool;

namespace {

void expectNear(Rgb a, Rgb b, float relative = 1e-6f) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], relative * std::abs(b[c])) << c;
}

/// As Cycles reads them: Volume Scatter gives density x colour, Volume Absorption density x (1 -
/// colour).
Rgb scattering(const CyclesMedium& m) { return m.scatterColour * m.density; }
Rgb absorption(const CyclesMedium& m) { return (Rgb(1) - m.absorbColour) * m.density; }

TEST(CyclesMapping, MediaKeepTheirCoefficients) {
    // What a Principled Volume of density 2 and these colours and absorption colours has.
    struct {
        Rgb sigmaS, sigmaA;
    } const cases[] = {{{1, 1.4f, 1.8f}, {1, 0.6f, 0.2f}},
                       {{1, 1.4f, 1.8f}, {0.5f, 0.3f, 0.1f}},
                       {{2.4f, 1.4f, 1.8f}, {0, 0.6f, 0.2f}},
                       {{0, 0, 0}, {3, 2, 0}},
                       {{5, 0, 1}, {0, 0, 0}}};
    for (const auto& c : cases) {
        const CyclesMedium m = cyclesMedium(c.sigmaA, c.sigmaS);
        EXPECT_EQ(m.sigmaA, c.sigmaA);
        EXPECT_EQ(m.sigmaS, c.sigmaS);
        expectNear(scattering(m), c.sigmaS);
        expectNear(absorption(m), c.sigmaA);
        EXPECT_EQ(m.scatters(), c.sigmaS.maximum() > 0);
        EXPECT_EQ(m.absorbs(), c.sigmaA.maximum() > 0);
        for (const Rgb& colour : {m.scatterColour, m.absorbColour}) {
            EXPECT_GE(colour.minimum(), 0);
            EXPECT_LE(colour.maximum(), 1);
        }
    }
    EXPECT_FALSE(cyclesMedium(Rgb(0), Rgb(0)).scatters());
    EXPECT_FALSE(cyclesMedium(Rgb(0), Rgb(0)).absorbs());
}

TEST(CyclesMapping, BlackBodiesRadiateAlike) {
    // Principled Volume's black body, of temperatures at which Cycles' colours are known.
    struct {
        double kelvin;
        Rgb colour, radiance;
    } const known[] = {{1500, {3.26431f, 0.43405f, -0.06424f}, {0.29828f, 0.039661f, -0.0058697f}},
                       {3000, {1.77084f, 0.84428f, 0.27222f}, {2.5890f, 1.2343f, 0.39799f}},
                       {6500, {1.04255f, 0.98405f, 1.03527f}, {33.590f, 31.705f, 33.356f}}};
    const Rgb colour(1, 0.5f, 0.25f);
    for (const double intensity : {1.0, 0.3, 20.0})
        for (const auto& k : known) {
            const double value = 0.7;  // of the grid
            const CyclesBlackbody b =
                cyclesBlackbody({"temperature", k.kelvin / value, 0, intensity, colour});
            const double kelvin = b.temperature * value;
            const double amount =
                1.80493578e-14 * (1 - b.intensity + b.intensity * std::pow(kelvin, 4));
            expectNear(b.tint * k.colour * static_cast<float>(amount),
                       colour * k.radiance * static_cast<float>(intensity), 1e-4f);
        }
}

TEST(CyclesMapping, WhatGlowsInGlassLosesASquaredIndexInCycles) {
    expectNear(cyclesEmissionWithin({1, 2, 9}, 1), {1, 2, 9});
    expectNear(cyclesEmissionWithin({1, 2, 9}, 1.5), {4.0f / 9, 8.0f / 9, 4});
}

TEST(CyclesMapping, OneBounceLessThanScatterings) {
    EXPECT_EQ(cyclesBounces(1), 0);
    EXPECT_EQ(cyclesBounces(8), 7);
    EXPECT_EQ(cyclesBounces(1025), 1024);
    EXPECT_EQ(cyclesBounces(5000), 1024);
    EXPECT_EQ(cyclesBounces(std::nullopt), 1024);
}

TEST(CyclesMapping, Lights) {
    const CyclesColour point = cyclesPoint({1, 2, 0.5f});
    EXPECT_NEAR(point.strength, 8 * pi, 1e-5);
    expectNear(point.colour, {0.5f, 1, 0.25f});
    const CyclesColour sun = cyclesColour({4, 2, 1});
    EXPECT_EQ(sun.strength, 4);
    expectNear(sun.colour, {1, 0.5f, 0.25f});
    EXPECT_EQ(cyclesColour(Rgb(0)).strength, 0);
}

/// Where in an image, u to the right and v downwards, Cycles looks for a direction.
std::pair<double, double> cyclesLookUp(Vec3d d) {
    return {0.5 - std::atan2(d.y, d.x) / (2 * pi), std::acos(d.z) / pi};
}
/// Where Woodcock's image has it.
std::pair<double, double> woodcockLookUp(Vec3d d) {
    return {0.5 + std::atan2(d.x, -d.z) / (2 * pi), std::acos(d.y) / pi};
}

TEST(CyclesMapping, EnvironmentImagesAreTurnedAlike) {
    RandomStream random(7);
    for (const UpAxis up : {UpAxis::Y, UpAxis::Z})
        for (const double rotation : {0.0, 70.0, -200.0}) {
            EnvironmentDescription environment;
            environment.up = up;
            environment.rotation = rotation;
            for (int i = 0; i < 20; ++i) {
                const Vec3d d = normalize(
                    Vec3d{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5});
                const auto expected =
                    woodcockLookUp(worldFromLight(environment).inverse().vector(d));
                const auto found = cyclesLookUp(cyclesImageFromWorld(environment).vector(d));
                EXPECT_NEAR(found.first, expected.first, 1e-12);
                EXPECT_NEAR(found.second, expected.second, 1e-12);
            }
        }
}

}  // namespace
}  // namespace woodcock::test
