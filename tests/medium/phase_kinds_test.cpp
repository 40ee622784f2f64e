// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/expect_error.h"
#include "woodcock/base/random.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/medium/phase.h"
#include "woodcock/proof/oracles/phase_functions.h"
#include "woodcock/proof/support/estimate.h"

namespace woodcock::test {

using namespace medium;
using namespace proof;

namespace {

constexpr double sevenDigits = 1e-8;

TEST(PhaseKinds, HaveTheValuesOfTheirFormulas) {
    EXPECT_NEAR(PhaseFunction(Rayleigh()).value(1), 0.11936621, sevenDigits);
    const Draine cornetteShanks(0.5, 1), dust(0.8, 20);
    EXPECT_NEAR(cornetteShanks.value(1), 0.63661977, sevenDigits);
    EXPECT_NEAR(cornetteShanks.value(0), 0.02847050, sevenDigits);
    EXPECT_NEAR(cornetteShanks.value(-1), 0.02357851, sevenDigits);
    EXPECT_NEAR(cornetteShanks.meanCosine(), 0.56666667, sevenDigits);
    EXPECT_NEAR(dust.value(1), 4.64201917, sevenDigits);
    EXPECT_NEAR(dust.meanCosine(), 0.89481481, sevenDigits);
    for (const double c : {-1.0, -0.3, 0.8, 1.0}) {
        EXPECT_DOUBLE_EQ(Draine(0.7, 0).value(c), henyeyGreenstein(c, 0.7));
        EXPECT_DOUBLE_EQ(Draine(0, 1).value(c), Rayleigh().value(c));
        EXPECT_DOUBLE_EQ(TwoLobes(0.7, -0.2, 0).value(c), henyeyGreenstein(c, 0.7));
        EXPECT_DOUBLE_EQ(TwoLobes(0.7, -0.2, 1).value(c), henyeyGreenstein(c, -0.2));
    }
}

/// Jendersie and d'Eon 2023, and below 5 micrometres the fits of its supplement.
TEST(PhaseKinds, DropletsHaveTheParametersOfTheFit) {
    struct Row {
        double diameter, gPeak, gWide, alpha, share, meanCosine, ahead, back;
    };
    for (const Row& r :
         {Row{5, 0.9706780, 0.5083416, 17.068098, 0.4478295, 0.843424, 101.13, 0.014782},
          Row{10, 0.9881767, 0.5556713, 21.995521, 0.4819554, 0.864164, 586.86, 0.012715},
          Row{20, 0.9946100, 0.5937906, 27.113694, 0.4981595, 0.879310, 2742.5, 0.010914},
          Row{50, 0.9979524, 0.6250845, 32.315428, 0.5076183, 0.891194, 18673, 0.0094831}}) {
        const MieDroplets mie(r.diameter);
        EXPECT_NEAR(mie.peak().g(), r.gPeak, 6e-8) << r.diameter;
        EXPECT_NEAR(mie.wide().g(), r.gWide, 6e-8);
        EXPECT_NEAR(mie.wide().alpha(), r.alpha, 6e-7);
        EXPECT_NEAR(mie.shareOfWide(), r.share, 6e-8);
        EXPECT_NEAR(mie.meanCosine(), r.meanCosine, 6e-7);
        EXPECT_NEAR(mie.value(1) / r.ahead, 1, 6e-5);
        EXPECT_NEAR(mie.value(-1) / r.back, 1, 6e-5);
    }
    const MieDroplets fog(3);
    EXPECT_NEAR(fog.peak().g(), 0.9459452, 6e-8);
    EXPECT_NEAR(fog.wide().g(), 0.4219728, 6e-8);
    EXPECT_NEAR(fog.wide().alpha(), 14.340509, 6e-7);
    EXPECT_NEAR(fog.shareOfWide(), 0.3808644, 6e-8);
}

TEST(PhaseKinds, SeaWaterScattersBackWhatItSays) {
    for (const double ior : {1.001, 1.05, 1.33, 1 + std::sqrt(2.0 / 3), 2.0})
        for (const double b : {1e-3, 0.0183, 0.1, 0.4, 0.499}) {
            const FournierForand sea(ior, b);
            // The innermost 4 arc seconds are even.
            const oracle::TurnDistribution turns([&](double c) { return sea.value(c); },
                                                 {1 - 2e-10});
            EXPECT_NEAR(turns(0), b, 2e-6) << ior;
            RandomStream random(5);
            int back = 0;
            constexpr int n = 20000;
            for (int i = 0; i < n; ++i) back += sea.sample(random.uniform()).cosine() < 0;
            EXPECT_NEAR(back / double{n}, b, 4 * std::sqrt(b * (1 - b) / n)) << ior;
        }
}

/// Where delta is 1, the formula divides zero by zero.
TEST(PhaseKinds, SeaWaterIsSmoothWhereItsFormulaIsNot) {
    const FournierForand sea(1.5, 0.1);
    const double x = 3 * 0.25 / 4;  // sin^2 of half the angle where delta is 1
    const auto at = [&](double shift) { return sea.value(1 - 2 * (x + shift)); };
    for (const double shift : {0.0, 1e-14, 1e-9, 1e-6, 1e-4, 5e-3, 9e-3, 1e-2}) {
        const double slope = (at(shift + 1e-4) - at(shift - 1e-4)) / 2e-4;
        EXPECT_LT(slope, 0) << shift;
        EXPECT_NEAR(at(shift + 5e-5), (at(shift) + at(shift + 1e-4)) / 2, 1e-8 * at(shift) * 100);
    }
}

std::vector<PhaseFunction> allKinds() {
    return {HenyeyGreenstein(0.9),
            HenyeyGreenstein(-0.9999),
            TwoLobes(0.999, -0.9, 0.2),
            Rayleigh(),
            Draine(0.9999, 1e6),
            Draine(-0.5, 3),
            Draine(0, 1e-9),
            MieDroplets(1.5),
            MieDroplets(4.999),
            MieDroplets(50),
            FournierForand(1.001, 1e-4),
            FournierForand(1.33, 0.1),
            FournierForand(2, 0.49),
            PhaseTable({{-1, 0, 1}, {{0, 1, 0}}}, true),
            PhaseTable({{-1, 0, 1}, {{0, 1, 0}, {1, 1, 1}, {0, 0, 1}}}, true)};
}

TEST(PhaseKinds, SampleFiniteUnitDirectionsWithTheirDensity) {
    RandomStream random(1);
    std::vector<PhaseFunction> kinds = allKinds();
    for (const PhaseFunction& kind : allKinds()) kinds.push_back(kind.towardsIsotropic(0.3));
    for (const PhaseFunction& kind : kinds)
        for (int i = 0; i < 2000; ++i) {
            const auto r = [&] { return 2 * random.uniform() - 1; };
            const Vec3d forward = normalize(Vec3d{r(), r(), r()});
            const double u = i == 0 ? 0 : i == 1 ? 1 - 0x1p-53 : random.uniform();
            const PhaseSample s = kind.sample(forward, u, random.uniform());
            ASSERT_NEAR(length(s.direction), 1, 1e-15) << kind.name();
            ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0) << kind.name();
            ASSERT_TRUE(std::isfinite(kind.value(dot(forward, s.direction)))) << kind.name();
        }
    for (const PhaseFunction& kind : kinds)
        for (const double c : {-1.0, 1.0, -1 - 1e-15, 1 + 1e-15}) {
            const double p = kind.value(c);
            EXPECT_TRUE(std::isfinite(p) && p >= 0) << kind.name();
        }
}

TEST(PhaseKinds, TowardsIsotropicScalesTheMeanCosine) {
    EXPECT_EQ(PhaseFunction(HenyeyGreenstein(0.8)).towardsIsotropic(0.25).value(0.3),
              henyeyGreenstein(0.3, 0.2));
    for (const PhaseFunction& kind : allKinds())
        for (const double factor : {1.0, 0.5, 0.125, 0.0}) {
            const PhaseFunction wider = kind.towardsIsotropic(factor);
            EXPECT_NEAR(wider.meanCosine(), factor * kind.meanCosine(), 1e-12) << kind.name();
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(wider.meanCosines()[c], factor * kind.meanCosines()[c], 1e-6);
            if (factor == 0) {
                EXPECT_NEAR(wider.value(0.9), 1 / (4 * pi), 1e-12) << kind.name();
            }
            Moments cosine;
            RandomStream random(3);
            for (int i = 0; i < 20000; ++i)
                cosine.add(wider.sample({0, 0, 1}, random.uniform(), random.uniform()).direction.z);
            const Estimate e(cosine);
            EXPECT_NEAR(e.mean, wider.meanCosine(), 4 * e.error + 1e-9) << kind.name();
        }
}

TEST(PhaseKinds, OnlyATableOfThreeColumnsIsChromatic) {
    for (const PhaseFunction& kind : allKinds()) {
        const auto* table = std::get_if<PhaseTable>(&kind.kind());
        EXPECT_EQ(kind.chromatic(), table && table->chromatic());
        if (kind.chromatic()) continue;
        EXPECT_EQ(kind.values(0.3), Rgb(static_cast<float>(kind.value(0.3))));
    }
}

template <class F>
void refuses(const char* text, F make) {
    expectError(ErrorKind::Input, text, make);
}

TEST(PhaseKinds, RefuseWhatIsOutOfRange) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    refuses("g is 1", [] { HenyeyGreenstein(1); });
    refuses("g is nan", [] { HenyeyGreenstein{nan}; });
    refuses("g is -1.5", [] { TwoLobes(0.5, -1.5, 0.1); });
    refuses("mix is 1.5", [] { TwoLobes(0.5, 0, 1.5); });
    refuses("mix is nan", [] { TwoLobes(0.5, 0, nan); });
    refuses("g is 2", [] { Draine(2, 1); });
    refuses("alpha is -1", [] { Draine(0.5, -1); });
    refuses("alpha is inf", [] { Draine(0.5, std::numeric_limits<double>::infinity()); });
    refuses("diameter is 1; the fits to Mie theory hold from 1.5 to 50", [] { MieDroplets(1); });
    refuses("diameter is 51", [] { MieDroplets(51); });
    refuses("diameter is nan", [] { MieDroplets{nan}; });
    refuses("ior is 1", [] { FournierForand(1, 0.1); });
    refuses("ior is 2.5", [] { FournierForand(2.5, 0.1); });
    refuses("backscatter is 0", [] { FournierForand(1.33, 0); });
    refuses("backscatter is 0.5", [] { FournierForand(1.33, 0.5); });
}

TEST(PhaseTable, RefusesWhatIsNoPhaseFunction) {
    const auto table = [](std::vector<double> cosines, std::vector<double> densities,
                          bool normalise = false) {
        return [=] { PhaseTable({cosines, {densities}}, normalise); };
    };
    const double even = 1 / (4 * pi);
    PhaseTable({{-1, 1}, {{even, even}}});
    refuses("0 rows", table({}, {}));
    refuses("1 rows", table({1}, {even}));
    refuses("do not rise: 0.5 comes after 0.5", table({-1, 0.5, 0.5, 1}, {1, 1, 1, 1}));
    refuses("reach from -0.9 to 1", table({-0.9, 1}, {even, even}));
    refuses("reach from -1 to 0.99", table({-1, 0.99}, {even, even}));
    refuses("do not rise", table({-1, std::nan(""), 1}, {even, even, even}));
    refuses("at the cosine 0 is -1", table({-1, 0, 1}, {1, -1, 1}, true));
    refuses("at the cosine 1 is inf", table({-1, 1}, {1, HUGE_VAL}, true));
    refuses("integral over the sphere is 2; it must be 1", table({-1, 1}, {2 * even, 2 * even}));
    refuses("integral over the sphere is 0", table({-1, 1}, {0, 0}, true));
    refuses("2 columns", [] { PhaseTable({{-1, 1}, {{1, 1}, {1, 1}}}, true); });
    EXPECT_DOUBLE_EQ(PhaseTable({{-1, 1}, {{7, 7}}}, true).value(0.2), even);
}

TEST(PhaseTable, IsReadFromText) {
    const TempDir dir;
    const auto file = dir / "phase.txt";
    const auto read = [&](const std::string& text, bool normalise = true) {
        writeText(file, text);
        return readPhaseTable(file, normalise);
    };
    EXPECT_NEAR(read("# cosine density\n-1 0.05\r\n\n0,0.05\n+1\t5e-2 # last\n").value(0.3),
                1 / (4 * pi), 1e-15);
    const PhaseTable colours = read("-1 1 0 1\n0 1 1 1\n1 1 2 3\n");
    EXPECT_TRUE(colours.chromatic());
    EXPECT_NEAR(colours.value(1, 1), 2 / (4 * pi), 1e-15);
    const auto refusesText = [&](const char* message, const std::string& text) {
        refuses(message, [&] { read(text, false); });
    };
    refusesText("phase.txt: the table has 0 rows", "");
    refusesText("phase.txt:2: expected a cosine and one density per steradian, or three",
                "#\n-1\n");
    refusesText("phase.txt:2: expected a cosine and one density, as in the rows before",
                "-1 1\n0 1 1 1\n");
    refusesText("phase.txt:2: expected a cosine and three densities", "-1 1 1 1\n0 1\n");
    refusesText("phase.txt:1: expected a cosine and", "-1 nan\n1 1\n");
    refusesText("phase.txt:1: expected a cosine and", "-1 0.1x\n1 1\n");
    refusesText("phase.txt:1: expected a cosine and", std::string("-1 0.1\0 2\n", 10));
    refusesText("phase.txt:1: expected a cosine and", std::string(10000, '1'));
    refusesText("phase.txt: the phase function's integral over the sphere is 12.5664; it must be 1",
                "-1 1\n1 1\n");
    refuses("cannot read", [&] { readPhaseTable(dir / "missing.txt"); });
    refuses("cannot read", [&] { readPhaseTable(dir.path()); });
}

}  // namespace
}  // namespace woodcock::test
