// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/oracles/plates.h"

#include <gtest/gtest.h>

#include <cmath>

#include "woodcock/base/vec.h"
#include "woodcock/proof/oracles/adding_doubling.h"

namespace woodcock::oracle {

using namespace oracle;

namespace {

const std::vector<double> cosines{1, 0.8, 0.5, 0.1, 0.01};

TEST(Plates, FacesReflectByFresnel) {
    // The textbook's formulas in angles (Born and Wolf, 1.5.2): squares of sin(a - b) / sin(a + b)
    // and tan(a - b) / tan(a + b)
    for (const double to : {1.2, 1.5, 2.4})
        for (const double a : {0.1, 0.7, 1.0, 1.5}) {
            const double b = std::asin(std::sin(a) / to);
            const FresnelReflectance in = fresnelReflectances(std::cos(a), 1, to);
            EXPECT_NEAR(in.s, std::pow(std::sin(a - b) / std::sin(a + b), 2), 1e-14);
            EXPECT_NEAR(in.p, std::pow(std::tan(a - b) / std::tan(a + b), 2), 1e-14);
            // The same backwards
            const FresnelReflectance out = fresnelReflectances(std::cos(b), to, 1);
            EXPECT_NEAR(out.s, in.s, 1e-13);
            EXPECT_NEAR(out.p, in.p, 1e-13);
        }
    EXPECT_NEAR(fresnelReflectances(1, 1, 1.5).mean(), 0.04, 1e-15);
    EXPECT_NEAR(fresnelReflectances(0.5, 1, 1.5).mean(), 0.0892, 5e-5);  // at 60 degrees
    EXPECT_EQ(fresnelReflectances(0, 1, 1.5).mean(), 1);
    EXPECT_NEAR(fresnelReflectances(std::cos(std::atan(1.5)), 1, 1.5).p, 0, 1e-30);  // Brewster
    const double critical = std::asin(1 / 1.5);
    EXPECT_EQ(fresnelReflectances(std::cos(critical + 1e-9), 1.5, 1).mean(), 1);
    EXPECT_LT(fresnelReflectances(std::cos(critical - 1e-3), 1.5, 1).mean(), 0.9);
    EXPECT_EQ(fresnelReflectances(0.3, 1.5, 1.5).mean(), 0);
}

TEST(Plates, OnePlateIsTheSumOfItsReflections) {
    for (const double index : {0.8, 1.0, 1.33, 1.5, 2.4})
        for (const double depth : {0.0, 0.2, 3.0})
            for (const double mu : cosines) {
                if (1 - mu * mu >= index * index) continue;
                SCOPED_TRACE(testing::Message() << index << ' ' << depth << ' ' << mu);
                const double inside = std::sqrt(1 - (1 - mu * mu) / (index * index));
                const double r = fresnelReflectances(mu, 1, index).mean(), t = 1 - r;
                const double a = std::exp(-depth / inside);
                double reflected = r, transmitted = 0, beam = t;
                for (int way = 0; way < 5000; ++way) {
                    beam *= a;
                    (way % 2 ? reflected : transmitted) += beam * t;
                    beam *= r;
                }
                const PlateAnswer plate = unpolarisedPlates({{index, depth}}, mu);
                EXPECT_NEAR(plate.reflectance, reflected, 1e-13);
                EXPECT_NEAR(plate.transmittance, transmitted, 1e-13);
                EXPECT_NEAR(plate.reflectance, r + t * t * r * a * a / (1 - r * r * a * a), 1e-13);
            }
}

TEST(Plates, WindowGlass) {
    const PlateAnswer window = unpolarisedPlates({{1.5, 0}}, 1);
    EXPECT_NEAR(window.reflectance, 1 / 13.0, 1e-15);
    EXPECT_NEAR(window.transmittance, 12 / 13.0, 1e-15);
    // Double glazing
    const PlateAnswer twice = unpolarisedPlates({{1.5, 0}, {1, 0}, {1.5, 0}}, 1);
    EXPECT_NEAR(twice.transmittance, 12 / 14.0, 1e-15);
}

TEST(Plates, PilesOfClearPlatesAreStokes) {
    for (const double mu : cosines)
        for (const int count : {1, 2, 7}) {
            std::vector<Plate> pile;
            for (int i = 0; i < count; ++i) pile.insert(pile.end(), {{1.52, 0}, {1, 0}});
            const auto stokes = [&](double r) { return (1 - r) / (1 + (2 * count - 1) * r); };
            const FresnelReflectance r = fresnelReflectances(mu, 1, 1.52);
            EXPECT_NEAR(unpolarisedPlates(pile, mu).transmittance, stokes(r.mean()), 1e-13);
            EXPECT_NEAR(polarisedPlates(pile, mu).transmittance, (stokes(r.s) + stokes(r.p)) / 2,
                        1e-13);
        }
}

TEST(Plates, OfNoRefractionAreBeerLambert) {
    for (const double mu : cosines) {
        const PlateAnswer plate = unpolarisedPlates({{1, 0.3}, {1, 0.4}}, mu);
        EXPECT_EQ(plate.reflectance, 0);
        EXPECT_NEAR(plate.transmittance, std::exp(-0.7 / mu), 1e-15);
    }
}

TEST(Plates, ConserveEnergyAndAreReciprocal) {
    const std::vector<Plate> clear{{1.5, 0}, {1.33, 0}, {2.4, 0}, {1, 0}, {1.7, 0}};
    const std::vector<Plate> tinted{{1.5, 0.1}, {1.33, 0.3}, {2.4, 0}, {1, 0.2}, {1.7, 1}};
    const std::vector<Plate> turned(tinted.rbegin(), tinted.rend());
    for (const double mu : cosines) {
        EXPECT_NEAR(unpolarisedPlates(clear, mu).absorptance(), 0, 1e-14);
        EXPECT_NEAR(polarisedPlates(clear, mu).absorptance(), 0, 1e-14);
        EXPECT_GT(unpolarisedPlates(tinted, mu).absorptance(), 0);
        EXPECT_NEAR(unpolarisedPlates(tinted, mu).transmittance,
                    unpolarisedPlates(turned, mu).transmittance, 1e-15);
    }
}

TEST(Plates, AgreeWithAddingDoubling) {
    for (const double index : {1.33, 1.5})
        for (const double depth : {0.1, 1.0}) {
            const Face f = solveSlab({{{depth, 0, 0}}, index}, cosines).above;
            for (std::size_t i = 0; i < cosines.size(); ++i) {
                const PlateAnswer plate = unpolarisedPlates({{index, depth}}, cosines[i]);
                EXPECT_NEAR(f.reflectance[i], plate.reflectance, 1e-8);
                EXPECT_NEAR(f.transmittance[i], plate.transmittance, 1e-8);
            }
        }
}

TEST(Plates, PolarisationMattersWhereLightIsOblique) {
    const std::vector<Plate> plate{{1.5, 0.2}};
    EXPECT_NEAR(unpolarisedPlates(plate, 1).reflectance, polarisedPlates(plate, 1).reflectance,
                1e-15);
    // At Brewster's angle all that a clear plate reflects is s; what passed twice is more of p.
    const double mu = std::cos(std::atan(1.5)), s = fresnelReflectances(mu, 1, 1.5).s;
    EXPECT_NEAR(polarisedPlates({{1.5, 0}}, mu).reflectance, s / (1 + s), 1e-15);
    EXPECT_NEAR(unpolarisedPlates({{1.5, 0}}, mu).reflectance, s / (1 + s / 2), 1e-15);
}

TEST(Plates, GapsBehindDenserMatterReflectAllBeyondTheCriticalAngle) {
    const std::vector<Plate> gap{{1, 0.3}};
    const double critical = std::sqrt(1 - 1 / (1.5 * 1.5));
    for (const double mu : {0.01, 0.5, critical - 1e-9}) {
        EXPECT_EQ(unpolarisedPlates(gap, mu, 1.5).reflectance, 1);
        EXPECT_EQ(unpolarisedPlates(gap, mu, 1.5).transmittance, 0);
    }
    EXPECT_LT(unpolarisedPlates(gap, critical + 1e-3, 1.5).reflectance, 1);
    // Met from inside a plate, through which light passes twice
    const double inside = std::sqrt(1 - 2.25 * (1 - 0.25) / 4),
                 r = fresnelReflectances(0.5, 1.5, 2).mean();
    const double a = std::exp(-2 * 0.1 / inside), t = 1 - r;
    const PlateAnswer twice = unpolarisedPlates({{2, 0.1}, {1, 0}}, 0.5, 1.5);
    EXPECT_NEAR(twice.reflectance, r + t * t * a / (1 - r * a), 1e-14);
    EXPECT_EQ(twice.transmittance, 0);
}

}  // namespace
}  // namespace woodcock::oracle
