// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/sample_sequence.h"
#include "tests/support/expect_mean.h"

#include <gtest/gtest.h>

#include <set>

namespace woodcock::test {
namespace {

std::uint32_t intervalOf(double u, int log2Count) {
    return static_cast<std::uint32_t>(std::ldexp(u, log2Count));
}

TEST(SampleSequence, EveryDimensionIsStratifiedInEveryAlignedRunOfSamples) {
    for (int log2Count : {1, 4, 7, 10})
        for (std::uint32_t set : {0u, 1u, 5u})
            for (std::uint32_t run : {0u, 3u}) {
                std::array<std::set<std::uint32_t>, 4> intervals;
                const std::uint32_t n = 1u << log2Count;
                for (std::uint32_t i = run * n; i < (run + 1) * n; ++i) {
                    const auto u = SampleSequence(9, 3, -4, i).draw(set);
                    for (std::size_t d = 0; d < 4; ++d) {
                        ASSERT_TRUE(u[d] >= 0 && u[d] < 1);
                        intervals[d].insert(intervalOf(u[d], log2Count));
                    }
                }
                for (const auto& filled : intervals) EXPECT_EQ(filled.size(), n);
            }
}

TEST(SampleSequence, TheFirstTwoDimensionsAreANet) {  // (0, m, 2) in base 2
    for (int m = 1; m <= 10; ++m)
        for (int a = 0; a <= m; ++a)
            for (std::uint32_t set : {0u, 2u}) {
                std::set<std::uint32_t> boxes;
                for (std::uint32_t i = 0; i < 1u << m; ++i) {
                    const auto u = SampleSequence(1, 17, 4, i).draw(set);
                    boxes.insert(intervalOf(u[0], a) << (m - a) | intervalOf(u[1], m - a));
                }
                EXPECT_EQ(boxes.size(), 1u << m) << "m " << m << " a " << a;
            }
}

TEST(SampleSequence, DependsOnNothingButItsName) {
    const auto u = SampleSequence(5, 6, 7, 8).draw(9);
    EXPECT_EQ(u, SampleSequence(5, 6, 7, 8).draw(9));
    EXPECT_NE(u, SampleSequence(6, 6, 7, 8).draw(9));
    EXPECT_NE(u, SampleSequence(5, 7, 7, 8).draw(9));
    EXPECT_NE(u, SampleSequence(5, 6, 8, 8).draw(9));
    EXPECT_NE(u, SampleSequence(5, 6, 7, 9).draw(9));
    EXPECT_NE(u, SampleSequence(5, 6, 7, 8).draw(10));
    EXPECT_NE(SampleSequence(5, 6, 7, 8).draw(9), SampleSequence(5, 7, 6, 8).draw(9));
}

TEST(SampleSequence, CopiesOfAllSamplesAreOneLongerSequence) {
    for (std::uint32_t copies : {1u, 2u, 3u, 8u})
        for (std::uint32_t sample : {0u, 1u, 77u})
            for (std::uint32_t k = 0; k < copies; ++k)
                EXPECT_EQ(SampleSequence(5, 6, 7, sample).copy(k, copies).draw(2),
                          SampleSequence(5, 6, 7, sample * copies + k).draw(2));
}

/// Correlation of two functions of a pixel: products of centred numbers, of mean 0 and variance 1
/// where they are independent.
template <class A, class B>
void expectUncorrelated(A&& a, B&& b, const char* what) {
    for (std::size_t d = 0; d < 4; ++d) {
        Moments product;
        for (int y = 0; y < 200; ++y)
            for (int x = 0; x < 200; ++x) product.add(12 * (a(x, y)[d] - 0.5) * (b(x, y)[d] - 0.5));
        expectMean(product, 0, 0.006, what);
    }
}

TEST(SampleSequence, PixelsSamplesAndSetsAreUncorrelated) {
    const auto draw = [](int dx, int dy, std::uint32_t sample, std::uint32_t set) {
        return [=](int x, int y) {
            return SampleSequence(3, 2 * x + dx, 2 * y + dy, sample).draw(set);
        };
    };
    expectUncorrelated(draw(0, 0, 0, 0), draw(1, 0, 0, 0), "a pixel and the next one");
    expectUncorrelated(draw(0, 0, 0, 0), draw(0, 1, 0, 0), "a pixel and the one below");
    expectUncorrelated(draw(0, 0, 5, 0), draw(0, 0, 5, 1), "two sets of a sample");
    expectUncorrelated(draw(0, 0, 1, 1), draw(0, 0, 1, 2), "two later sets");
}

TEST(SampleSequence, IntegratesASmoothFunctionFarBetterThanRandomNumbers) {
    double squares = 0;
    constexpr int pixels = 64, n = 1024;
    for (int x = 0; x < pixels; ++x) {
        double sum = 0;
        for (std::uint32_t i = 0; i < n; ++i) {
            const auto u = SampleSequence(2, x, 0, i).draw(0);
            sum += u[0] * u[1] * u[2] * u[3] * 16 - 1;
        }
        squares += sum * sum / n / n / pixels;
    }
    const double random = (std::pow(4.0 / 3, 4) - 1) / n;  // variance of a mean of n
    EXPECT_LT(squares, random / 50);
    EXPECT_GT(squares, 0);
}

}  // namespace
}  // namespace woodcock::test
