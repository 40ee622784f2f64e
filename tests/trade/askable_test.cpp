// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/askable.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace woodcock::test {

using namespace trade;

namespace {

bool has(const std::vector<double>& numbers, double v) {
    return std::ranges::find(numbers, v) != numbers.end();
}

TEST(Askable, NumbersAreRound) {
    const std::vector<double> numbers = roundNumbers({0.095, 120}, {1e-3, 1e6});
    EXPECT_TRUE(std::ranges::is_sorted(numbers));
    EXPECT_EQ(std::ranges::adjacent_find(numbers), numbers.end());
    EXPECT_EQ(numbers.front(), 1e-3);
    EXPECT_EQ(numbers.back(), 1e6);
    for (const double v : {0.003, 0.09, 0.095, 0.1, 0.11, 0.3, 1.0, 7.4, 10.0, 99.0, 100.0, 110.0,
                           120.0, 200.0, 3000.0})
        EXPECT_TRUE(has(numbers, v)) << v;
    for (const double v : {0.094, 0.012, 1.05, 130.0, 3600.0}) EXPECT_FALSE(has(numbers, v)) << v;
    // From 0.095: 5 + 90 x 3 + 3; before and after: 2 decades of 9 less 1, and 3 decades, 8 and 1.
    EXPECT_EQ(numbers.size(), 5u + 270 + 3 + 18 + 8 + 27 + 1);
}

TEST(Askable, FineNumbersMayGoBeyondTheCoarse) {
    const std::vector<double> numbers = roundNumbers({1.3e-5, 2.4e3}, {1e-3, 1});
    EXPECT_EQ(numbers.front(), 1.3e-5);
    EXPECT_EQ(numbers.back(), 2400);
}

/// Two candidates that differ in speed, and a reading.
TradeResult result() {
    TradeResult result;
    result.candidates.resize(2);
    result.candidates[0].model = {0.1234, {}, {2, 2}};
    result.candidates[1].model = {3, {0.01, 0}, {1, 1}, true};
    result.candidates[1].points = {{4, 12, {}, {}}, {16, 48, {}, {}}};
    result.equalTime = {{1, {}}, {60, {}}};
    return result;
}

TEST(Askable, TimesReachFromTheFirstSampleToTheLastReading) {
    TradeResult r = result();
    EXPECT_EQ(sensibleTimes(r, 20).low, 0.13) << "in which a sample ends";
    EXPECT_EQ(sensibleTimes(r, 20).high, 60);
    EXPECT_EQ(sensibleTimes(r, 121).high, 130);
    r.candidates[0].points = {{4, 600, {}, {}}};
    EXPECT_EQ(sensibleTimes(r, 20).high, 600);
    r.candidates.emplace_back();  // not measured
    EXPECT_EQ(sensibleTimes(r, 20).low, 0.13);
}

// After 0.13 s the error is 15.4; after 60 s 0.01 + 1 / 60 = 0.0267.
TEST(Askable, ErrorsReachFromTheLeastToOne) {
    TradeResult r = result();
    const Range range = sensibleErrors(r, sensibleTimes(r, 20));
    EXPECT_EQ(range.low, 0.026);
    EXPECT_EQ(range.high, 1);
    r.equalError = {{0.001, {}}};
    EXPECT_EQ(sensibleErrors(r, {0.13, 60}).low, 0.001);
    EXPECT_EQ(sensibleErrors(r, {4, 60}).high, 0.26) << "1 / 4 + 0.01";
    r = result();
    for (CandidateResult& c : r.candidates)
        for (double& cost : c.model.costs) cost *= 1e4;
    EXPECT_EQ(sensibleErrors(r, {0.13, 60}).high, 160000) << "where all errors are larger than 1";
}

TEST(Askable, WithoutNoiseAnyErrorWillDo) {
    TradeResult r = result();
    for (CandidateResult& c : r.candidates) c.model = {1, {}, {0, 0}};
    const Range range = sensibleErrors(r, sensibleTimes(r, 20));
    EXPECT_GT(range.low, 0);
    EXPECT_GT(range.high, range.low);
}

}  // namespace
}  // namespace woodcock::test
