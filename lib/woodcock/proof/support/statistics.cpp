// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/support/statistics.h"

#include <cmath>
#include <limits>

#include "woodcock/base/vec.h"

namespace woodcock::proof {

namespace {

/// Regularised upper incomplete gamma function: the series of its complement for small x, Lentz's
/// continued fraction for large.
double upperGamma(double a, double x) {
    if (x <= 0) return 1;
    const double factor = std::exp(-x + a * std::log(x) - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (int n = 1; n < 10000 && term > sum * 1e-15; ++n) sum += term *= x / (a + n);
        return 1 - factor * sum;
    }
    double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
    for (int n = 1; n < 10000; ++n) {
        const double an = -n * (n - a);
        b += 2;
        d = 1 / (an * d + b);
        c = b + an / c;
        h *= d * c;
        if (std::abs(d * c - 1) < 1e-14) break;
    }
    return factor * h;
}

struct ChiSquare {
    double statistic = 0;
    int freedom = 0;
};

ChiSquare chiSquare(const std::vector<double>& counts, const std::vector<double>& expected) {
    ChiSquare result{0, -1};
    double pooledCount = 0, pooledExpected = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (expected[i] <= 0) {
            if (counts[i] > 0) result.statistic = std::numeric_limits<double>::infinity();
            continue;
        }
        pooledCount += counts[i], pooledExpected += expected[i];
        if (pooledExpected < 10 && i + 1 < counts.size()) continue;
        const double d = pooledCount - pooledExpected;
        result.statistic += d * d / pooledExpected;
        ++result.freedom;
        pooledCount = pooledExpected = 0;
    }
    return result;
}

}  // namespace

double chiSquareProbability(const std::vector<double>& counts,
                            const std::vector<double>& expected) {
    const auto [statistic, freedom] = chiSquare(counts, expected);
    if (std::isinf(statistic)) return 0;
    return freedom > 0 ? upperGamma(freedom / 2.0, statistic / 2) : 1;
}

double chiSquareDeviate(const std::vector<double>& counts, const std::vector<double>& expected) {
    const auto [statistic, freedom] = chiSquare(counts, expected);
    if (std::isinf(statistic) || freedom < 1) return statistic;
    const double variance = 2.0 / (9 * freedom);
    return (std::cbrt(statistic / freedom) - (1 - variance)) / std::sqrt(variance);
}

std::vector<std::pair<double, double>> gaussLegendre(int n) {
    std::vector<std::pair<double, double>> rule;
    for (int i = 0; i < n; ++i) {
        double x = std::cos(pi * (i + 0.75) / (n + 0.5)), slope = 1;
        for (int newton = 0; newton < 20; ++newton) {
            double p = 1, before = 0;
            for (int k = 1; k <= n; ++k)
                before = std::exchange(p, ((2 * k - 1) * x * p - (k - 1) * before) / k);
            slope = n * (x * p - before) / (x * x - 1);
            x -= p / slope;
        }
        rule.emplace_back(x, 2 / ((1 - x * x) * slope * slope));
    }
    return rule;
}

}  // namespace woodcock::proof
