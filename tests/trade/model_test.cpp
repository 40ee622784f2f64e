// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/model.h"

#include <gtest/gtest.h>

#include <cmath>

namespace woodcock::test {

using namespace trade;

namespace {

/// Unbiased: variance 4 at half a second a sample.
const TradeModel slow{0.5, {}, {2, 2, 2, 2}};
/// A fifth of the noise, a bias of 10 %.
const TradeModel biased{0.1, {0.01, 0}, {0.4, 0.4, 0.4, 0.4}, true};

TEST(TradeModel, ErrorFallsWithTimeToTheBias) {
    EXPECT_DOUBLE_EQ(slow.errorAt(10)->value, 0.2);
    EXPECT_DOUBLE_EQ(biased.errorAt(10)->value, 0.05);
    EXPECT_DOUBLE_EQ(biased.errorAt(1e9)->value, 0.01 + 0.4e-9);
    EXPECT_EQ(slow.samplesIn(10.3), 20);
    EXPECT_EQ(slow.samplesIn(0.4), 0);
    EXPECT_FALSE(slow.errorAt(0.4));
}

TEST(TradeModel, TimeToAnErrorIsTheInverse) {
    EXPECT_DOUBLE_EQ(slow.secondsTo(0.2)->value, 10);
    EXPECT_DOUBLE_EQ(biased.secondsTo(0.05)->value, 10);
    EXPECT_FALSE(biased.secondsTo(0.01));
    EXPECT_DOUBLE_EQ(slow.secondsTo(1e6)->value, 0.5) << "a sample at least";
    EXPECT_EQ(slow.samplesTo(0.2), 20);
    EXPECT_EQ(slow.samplesTo(0.19), 22) << "21.05, but whole ones";
    EXPECT_EQ(slow.samplesTo(1e6), 1);
    EXPECT_FALSE(biased.samplesTo(0.01));
}

TEST(TradeModel, LoadingPassesBeforeTheFirstSample) {
    TradeModel loaded = biased;
    loaded.fixedSeconds = 3;
    EXPECT_DOUBLE_EQ(loaded.firstSample(), 3.1);
    EXPECT_FALSE(loaded.errorAt(3.05));
    EXPECT_EQ(loaded.samplesIn(2), 0);
    EXPECT_EQ(loaded.samplesIn(13.05), 100);
    EXPECT_DOUBLE_EQ(loaded.errorAt(13)->value, 0.05);
    EXPECT_DOUBLE_EQ(loaded.secondsTo(0.05)->value, 13);
    EXPECT_EQ(loaded.samplesTo(0.05), biased.samplesTo(0.05));
}

// The squared bias is 0.01 after 64 seconds, and falls as 1 / sqrt(t) until then.
TEST(TradeModel, ABiasMayFallWithTimeUntilItWasMeasured) {
    TradeModel denoised{0.5, {0.01, 0}, {0.4, 0.4}, true};
    denoised.biasPower = 0.5, denoised.biasSeconds = 64;
    EXPECT_DOUBLE_EQ(denoised.errorAt(4)->value, 0.01 * 4 + 0.4 / 4);
    EXPECT_DOUBLE_EQ(denoised.errorAt(64)->value, 0.01 + 0.4 / 64);
    EXPECT_DOUBLE_EQ(denoised.errorAt(1000)->value, 0.01 + 0.4 / 1000) << "and stays";
    EXPECT_NEAR(denoised.secondsTo(0.14)->value, 4, 1e-9);
    EXPECT_NEAR(denoised.secondsTo(0.01 + 0.4 / 64)->value, 64, 1e-6);
    EXPECT_NEAR(denoised.secondsTo(0.0104)->value, 1000, 1e-6);
    EXPECT_DOUBLE_EQ(denoised.secondsTo(100)->value, 0.5) << "a sample at least";
    EXPECT_FALSE(denoised.secondsTo(0.01));
    EXPECT_EQ(denoised.samplesTo(0.14), 8);
    EXPECT_NEAR(errorDifference(denoised, slow, 4).value, 0.14 - 0.5, 1e-12);
    denoised.fixedSeconds = 2;
    EXPECT_NEAR(denoised.secondsTo(0.14)->value, 6, 1e-9);
    EXPECT_DOUBLE_EQ(denoised.errorAt(6)->value, 0.14);
}

TEST(TradeModel, WhatWasNotMeasuredTakesPartInNothing) {
    const TradeModel unknown;
    EXPECT_FALSE(unknown.errorAt(1));
    EXPECT_FALSE(unknown.secondsTo(1));
    EXPECT_FALSE(unknown.samplesTo(1));
    EXPECT_EQ(bestAt({unknown, slow}, 10)->best, 1u);
    EXPECT_TRUE(bestAt({unknown, slow}, 10)->tied.empty());
    EXPECT_FALSE(bestAt({unknown}, 10));
}

TEST(TradeModel, ErrorsCarryThoseOfNoiseAndBias) {
    const TradeModel model{1, {0.02, 0.003}, {1, 3}};  // mean 2, standard error 1
    EXPECT_NEAR(model.errorAt(100)->se, std::hypot(0.003, 0.01), 1e-12);
    // d t / d cost = 1 / room, d t / d bias = t / room, at room = 0.04 and t = 50.
    EXPECT_NEAR(model.secondsTo(0.06)->se, std::hypot(1 / 0.04, 50 * 0.003 / 0.04), 1e-9);
    EXPECT_DOUBLE_EQ(model.careful().biasError(), 0.026);
}

TEST(TradeModel, ANegativeSquareIsNoise) {
    const TradeModel model{1, {-0.1, 0.2}, {1, 1}};
    EXPECT_DOUBLE_EQ(model.errorAt(10)->value, 0.1);
    EXPECT_DOUBLE_EQ(model.careful().errorAt(10)->value, 0.5);
}

// Lines cross where 2 / t = 0.01 + 0.4 / t: at 160 seconds.
TEST(Pareto, BiasWinsEarlyAndLoses) {
    const std::vector<TradeModel> models{slow, biased};
    EXPECT_EQ(bestAt(models, 159)->best, 1u);
    EXPECT_EQ(bestAt(models, 161)->best, 0u);
    EXPECT_TRUE(bestAt(models, 161)->tied.empty());
    EXPECT_EQ(bestAt(models, 0.2)->best, 1u) << "the other has no time for a sample";
    EXPECT_FALSE(bestAt(models, 0.05));
    EXPECT_EQ(fastestTo(models, 0.02)->best, 1u);
    EXPECT_EQ(fastestTo(models, 0.012)->best, 0u);

    const std::vector<FrontPoint> front = paretoFront(models, 1000, 200);
    ASSERT_EQ(front.size(), 200u);
    EXPECT_NEAR(front.front().seconds, 0.1, 1e-6);
    EXPECT_NEAR(front.back().seconds, 1000, 1e-6);
    for (const FrontPoint& p : front) {
        EXPECT_EQ(p.candidate, p.seconds < 160 ? 1u : 0u) << p.seconds;
        EXPECT_DOUBLE_EQ(p.error, models[p.candidate].errorAt(p.seconds)->value);
    }
}

// Costs scatter by far more than they differ, and in step: only seed by seed can they be told
// apart.
TEST(Pareto, SeedsAreCompared) {
    TradeModel a{1, {}, {1, 2, 4, 8}}, b{1, {}, {1.1, 2.1, 4.1, 8.1}};
    EXPECT_TRUE(bestAt({a, b}, 10)->tied.empty());
    b.costs = {8.1, 4.1, 2.1, 1.1};
    EXPECT_EQ(bestAt({a, b}, 10)->tied, std::vector<std::size_t>{1});
    EXPECT_NEAR(errorDifference(b, a, 10).value, 0.01, 1e-12);
}

// The scatter cancels also where they do not render for the same time.
TEST(Pareto, SeedsAreComparedAfterLoading) {
    const TradeModel a{1, {}, {1, 2, 4, 8}};
    TradeModel b{1, {}, {0.5, 1, 2, 4}};
    b.fixedSeconds = 5;  // half the time of rendering at half the noise
    const Measured difference = errorDifference(a, b, 10);
    EXPECT_NEAR(difference.value, 0, 1e-12);
    EXPECT_NEAR(difference.se, 0, 1e-12);
    b.fixedSeconds = 6;
    EXPECT_EQ(bestAt({a, b}, 10)->best, 0u);
    b.fixedSeconds = 4;
    EXPECT_EQ(bestAt({a, b}, 10)->best, 1u);
    EXPECT_FALSE(errorDifference(a, b, 10).value < 0);
}

TEST(Pareto, OnlyTheUnbiasedTakePartWhereAsked) {
    const std::vector<TradeModel> models{biased, slow};
    EXPECT_EQ(bestAt(models, 10)->best, 0u);
    EXPECT_EQ(bestAt(models, 10, Among::Unbiased)->best, 1u);
    EXPECT_EQ(fastestTo(models, 0.02)->best, 0u);
    EXPECT_EQ(fastestTo(models, 0.02, Among::Unbiased)->best, 1u);
    EXPECT_FALSE(bestAt({biased}, 10, Among::Unbiased));
}

// Of those that cannot be told apart, an unbiased one is taken: the better of two. Costs vary by
// seed so that 2 % are not significant.
TEST(Pareto, RecommendsTheBestUnbiasedAmongEquals) {
    const TradeModel best{1, {0, 1e-9}, {1, 2, 4, 8}, true};
    const TradeModel worse{1, {}, {8.4, 4.2, 2.1, 1.05}}, better{1, {}, {8.2, 4.1, 2.05, 1.025}};
    for (const auto& winner :
         {bestAt({best, worse, better}, 10), fastestTo({best, worse, better}, 1)}) {
        EXPECT_EQ(winner->best, 0u);
        EXPECT_EQ(winner->tied, (std::vector<std::size_t>{1, 2}));
        EXPECT_EQ(winner->recommended, 2u);
    }
    EXPECT_EQ(bestAt({better, best, slow}, 0.7)->recommended, 2u) << "the others had no time";
    const TradeModel alike{1, {}, {1.01, 2.02, 4.04, 8.08}};
    EXPECT_EQ(bestAt({alike, better}, 10)->recommended, bestAt({alike, better}, 10)->best)
        << "where the best is unbiased, it is taken";
    EXPECT_EQ(bestAt({biased, slow}, 10)->recommended, 0u) << "nobody is tied with it";
}

TEST(Pareto, AnUncertainBiasTies) {
    TradeModel uncertain = biased;
    uncertain.squaredBias.se = 0.01;
    const std::vector<TradeModel> models{slow, uncertain};
    EXPECT_EQ(bestAt(models, 250)->best, 0u);
    EXPECT_EQ(bestAt(models, 250)->tied, std::vector<std::size_t>{1});
}

}  // namespace
}  // namespace woodcock::test
