// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/oracles/phase_functions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "woodcock/base/vec.h"
#include "woodcock/proof/oracles/adding_doubling.h"
#include "woodcock/proof/oracles/closed_forms.h"
#include "woodcock/proof/oracles/published_phase_functions.h"

namespace woodcock::oracle {

namespace {

TEST(PhaseOracles, HavePublishedValues) {
    EXPECT_NEAR(rayleigh(1), 0.11936621, 1e-8);
    EXPECT_NEAR(draine(1, 0.5, 1), 0.63661977, 1e-8);
    EXPECT_NEAR(draine(0, 0.5, 1), 0.02847050, 1e-8);
    EXPECT_NEAR(draine(1, 0.8, 20), 4.64201917, 1e-8);
    EXPECT_NEAR(draineMeanCosine(0.8, 20), 0.89481481, 1e-8);
    EXPECT_NEAR(mieDroplets(1, 20) / 2742.5, 1, 3e-5);
    EXPECT_NEAR(mieDroplets(-1, 20) / 0.010914, 1, 1e-4);
}

TEST(PhaseOracles, TurnDistributionIntegrates) {
    for (const double g : {0.0, 0.9, -0.99}) {
        const TurnDistribution turns([&](double c) { return henyeyGreenstein(c, g); });
        EXPECT_NEAR(turns.total(), 1, 1e-12) << g;
        EXPECT_NEAR(turns.meanCosine(), g, 1e-12);
        for (const double c : {-0.99, -0.3, 0.0, 0.7, 0.999})
            EXPECT_NEAR(turns(c), henyeyGreensteinCdf(c, g), 1e-12) << g << ' ' << c;
    }
    const TurnDistribution dust([](double c) { return draine(c, 0.8, 20); });
    EXPECT_NEAR(dust.total(), 1, 1e-12);
    EXPECT_NEAR(dust.meanCosine(), draineMeanCosine(0.8, 20), 1e-12);
    const TurnDistribution sea([](double c) { return fournierForand(std::acos(c), 1.33, 0.1); });
    EXPECT_NEAR(sea.total(), 1, 1e-4);
    EXPECT_NEAR(sea(0), 0.1, 1e-4);
}

TEST(PhaseOracles, MomentsAndSeriesAreInverse) {
    const auto moments = legendreMoments([](double c) { return henyeyGreenstein(c, 0.9); }, 300);
    for (std::size_t l = 0; l < moments.size(); ++l)
        EXPECT_NEAR(moments[l], std::pow(0.9, static_cast<double>(l)), 1e-12) << l;
    for (const double c : {-1.0, -0.4, 0.9, 1.0})
        EXPECT_NEAR(legendreSeries(c, moments), henyeyGreenstein(c, 0.9), 1e-9) << c;
    const auto air = legendreMoments(rayleigh, 5);
    for (std::size_t l = 0; l < air.size(); ++l)
        EXPECT_NEAR(air[l], l < 3 ? rayleighMoments[l] : 0, 1e-14);
}

TEST(PhaseOracles, HazeAndCloudAreNowhereNegative) {
    for (int i = 0; i <= 10000; ++i) {
        const double c = std::cos(pi * i / 10000);
        EXPECT_GT(legendreSeries(c, hazeL), 0) << c;
        EXPECT_GT(legendreSeries(c, cloudC1), 0) << c;
    }
}

TEST(AddingDoubling, TakesMomentsAsItTakesG) {
    for (const double g : {0.5, -0.3, 0.75}) {
        std::vector<double> moments;
        for (int l = 0; l < 120; ++l) moments.push_back(std::pow(g, l));
        const std::vector<double> mu{1, 0.5, 0.1};
        const Face a = solveSlab({{{3, 0.9, g}}}, mu).above;
        const Face b = solveSlab({{{3, 0.9, 0, moments}}}, mu).above;
        for (std::size_t i = 0; i < mu.size(); ++i) {
            EXPECT_NEAR(a.reflectance[i], b.reflectance[i], 1e-7);
            EXPECT_NEAR(a.transmittance[i], b.transmittance[i], 1e-7);
        }
    }
}

/// Six digits of DISORT, for phase functions of up to 299 moments.
TEST(AddingDoubling, AgreesWithDisortOnAirHazeAndCloud) {
    for (const PublishedFlux& f : disortFluxes) {
        const std::size_t nodes = f.moments.size() > 120 ? 152 : 64;
        const Face face =
            solveSlab({{{f.opticalDepth, f.albedo, 0, f.moments}}}, {f.mu}, nodes).above;
        const double error = f.mu < 0.1 ? 2e-4 : 1e-5;  // of 16 directions, grazing light
        EXPECT_NEAR(face.reflectance[0] * f.beam, f.up, error * f.up) << f.name;
        EXPECT_NEAR(face.transmittance[0] * f.beam, f.down, error * f.down) << f.name;
    }
}

}  // namespace
}  // namespace woodcock::oracle
