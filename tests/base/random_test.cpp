// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/random.h"
#include "tests/support/expect_mean.h"

#include <gtest/gtest.h>

#include <set>

#include "woodcock/proof/support/statistics.h"

namespace woodcock::test {

using namespace proof;

namespace {

TEST(Random, IsSplitMix64) {
    RandomStream random(1234567);  // the generator's published output for this seed
    for (std::uint64_t expected : {6457827717110365317u, 3203168211198807973u, 9817491932198370423u,
                                   4593380528125082431u, 16408922859458223821u})
        EXPECT_EQ(random.bits(), expected);
}

TEST(Random, NumbersStayInTheirIntervalsAndAreEven) {
    RandomStream random(1);
    constexpr int n = 200000;
    std::vector<double> counts(100), expected(100, n / 100.0);
    Moments open;
    for (int i = 0; i < n; ++i) {
        const double u = random.uniform(), v = random.uniformOpenLow();
        ASSERT_TRUE(u >= 0 && u < 1 && v > 0 && v <= 1);
        ++counts[static_cast<std::size_t>(u * 100)];
        open.add(v);
    }
    EXPECT_GT(chiSquareProbability(counts, expected), leastProbability);
    expectMean(open, 0.5, 1e-3, "uniformOpenLow");
}

TEST(Random, HashesTellNeighbouringNamesApart) {
    std::set<std::uint64_t> hashes;
    for (std::uint64_t a = 0; a < 40; ++a)
        for (std::uint64_t b = 0; b < 40; ++b)
            for (std::uint64_t c = 0; c < 40; ++c) hashes.insert(hashOf(a, b, c));
    EXPECT_EQ(hashes.size(), 64000u);
    EXPECT_NE(hashOf(1, 0), hashOf(1));
}

TEST(Random, EveryInputBitOfAHashReachesEveryOutputBit) {
    for (int in = 0; in < 64; ++in) {
        std::array<Moments, 64> flipped;
        for (std::uint64_t i = 0; i < 2000; ++i) {
            const std::uint64_t change = hashOf(7, i) ^ hashOf(7, i ^ (std::uint64_t{1} << in));
            for (std::size_t out = 0; out < 64; ++out)
                flipped[out].add(static_cast<double>(change >> out & 1));
        }
        for (const Moments& m : flipped) EXPECT_NEAR(m.mean(), 0.5, 6 * 0.5 / std::sqrt(2000.0));
    }
}

}  // namespace
}  // namespace woodcock::test
