// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/plan.h"

#include <gtest/gtest.h>

#include <cmath>

namespace woodcock::test {

using namespace trade;

namespace {

double secondsOf(const TradePlan& plan, const std::vector<PilotCost>& costs,
                 const PilotCost& reference) {
    double seconds = tradeReferenceSeeds * plan.reference * reference.secondsPerSample;
    for (std::size_t i = 0; i < costs.size(); ++i)
        seconds += tradeSeeds * plan.candidates[i] * costs[i].secondsPerSample;
    return seconds;
}

TEST(TradePlan, SharesByTheRootOfVarianceTimesCost) {
    const std::vector<PilotCost> costs{{0.001, 1, 1}, {0.001, 4, 1}, {0.004, 4, 0.25}};
    const PilotCost reference{0.002, 2, 1};
    const TradePlan plan = planTrade(costs, reference, 60, 4);
    EXPECT_NEAR(plan.seconds, secondsOf(plan, costs, reference), 1e-9);
    EXPECT_LE(plan.seconds, 60);
    EXPECT_GT(plan.seconds, 59.8);
    // Twice the deviation at the same price: twice the time, so twice the samples.
    EXPECT_NEAR(double(plan.candidates[1]) / plan.candidates[0], 2, 0.01);
    // root(0.25 x 4 x 0.004) / root(4 x 0.001) = 1 in time, at four times the price.
    EXPECT_NEAR(double(plan.candidates[2]) / plan.candidates[1], 0.25, 0.01);
    // root((1 + 1 + 0.25) x 2 x 0.002) / root(0.001) = 3 in time; seeds are twice as many.
    EXPECT_NEAR(double(plan.reference) / plan.candidates[0], 3.0 / 2 / 2, 0.01);
}

// What the plan makes least: the weighted sum of errors of candidate and reference.
TEST(TradePlan, NoNeighbourIsBetter) {
    const std::vector<PilotCost> costs{{0.001, 3, 1}, {0.01, 0.5, 1}};
    const PilotCost reference{0.003, 2, 1};
    const double seconds = 100;
    const auto objective = [&](const std::vector<double>& shares) {
        double sum = 0, left = seconds;
        for (std::size_t i = 0; i < costs.size(); ++i) {
            sum += costs[i].variance * costs[i].secondsPerSample / shares[i];
            left -= shares[i];
        }
        return sum + 2 * reference.variance * reference.secondsPerSample / left;
    };
    const TradePlan plan = planTrade(costs, reference, seconds, 1);
    std::vector<double> shares;
    for (std::size_t i = 0; i < costs.size(); ++i)
        shares.push_back(tradeSeeds * plan.candidates[i] * costs[i].secondsPerSample);
    const double best = objective(shares);
    for (const double step : {-3.0, 3.0})
        for (std::size_t i = 0; i < shares.size(); ++i) {
            std::vector<double> other = shares;
            other[i] += step;
            EXPECT_GT(objective(other), best);
        }
}

TEST(TradePlan, NobodyGetsLessThanTheLeast) {
    const std::vector<PilotCost> costs{{0.001, 0, 1}, {1, 1e-6, 1}, {0.001, 1, 1}};
    const PilotCost reference{0.001, 1, 1};
    const TradePlan enough = planTrade(costs, reference, 40, 4);
    EXPECT_EQ(enough.candidates[0], 4);
    EXPECT_EQ(enough.candidates[1], 4);
    EXPECT_GT(enough.candidates[2], 1000);
    EXPECT_LE(enough.seconds, 40);
    const TradePlan tooFew = planTrade(costs, reference, 1, 4);
    EXPECT_EQ(tooFew.candidates, (std::vector<int>{4, 4, 4}));
    EXPECT_GT(tooFew.seconds, 16) << "it says that it takes longer";
}

TEST(PictureSize, KeepsTheShape) {
    const PictureSize size = sizeOfPixels({960, 540}, 10000);
    EXPECT_NEAR(size.pixels(), 10000, 200);
    EXPECT_NEAR(double(size.width) / size.height, 960.0 / 540, 0.03);
    EXPECT_EQ(sizeOfPixels({32, 18}, 1e6).width, 32);
    EXPECT_EQ(sizeOfPixels({1000, 1}, 10).height, 1);
}

}  // namespace
}  // namespace woodcock::test
