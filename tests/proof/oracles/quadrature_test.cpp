// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/oracles/quadrature.h"

#include <gtest/gtest.h>

namespace woodcock::oracle {

using namespace oracle;

namespace {

TEST(GaussLegendre, IsExactForPolynomials) {
    for (const std::size_t n : {1u, 2u, 5u, 32u, 64u, 200u}) {
        const Quadrature rule = gaussLegendre(n);
        for (std::size_t degree = 0; degree < 2 * n; degree = 2 * degree + 1) {
            double sum = 0;
            for (std::size_t i = 0; i < n; ++i)
                sum += rule.weights[i] * std::pow(rule.nodes[i], static_cast<double>(degree));
            EXPECT_NEAR(sum, 1 / static_cast<double>(degree + 1), 1e-14) << n << ' ' << degree;
        }
    }
}

TEST(TanhSinh, IsExactForSmoothCrowdedAndSingularFunctions) {
    EXPECT_NEAR(tanhSinh([](double x, double) { return std::exp(x); }, -1, 2),
                std::exp(2.0) - std::exp(-1.0), 1e-13);
    EXPECT_NEAR(tanhSinh([](double x, double) { return std::log(x); }, 0, 1), -1, 1e-13);
    EXPECT_NEAR(tanhSinh([](double x, double) { return std::exp(-1e6 * x); }, 0, 1) * 1e6, 1,
                1e-12);
}

TEST(TanhSinh, KnowsTheDistanceToTheNearerEnd) {
    const auto logFromAbove = [](double x, double d) { return std::log(x < 1.5 ? 2 - x : d); };
    EXPECT_NEAR(tanhSinh(logFromAbove, 1, 2), -1, 1e-13);
    double least = 1;
    tanhSinh([&](double, double d) { return least = std::min(least, d), 0.0; }, 1, 2);
    EXPECT_LT(least, 1e-30);
    EXPECT_GT(least, 0);
}

}  // namespace
}  // namespace woodcock::oracle
