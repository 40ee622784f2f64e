// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/support/statistics.h"

#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>

namespace woodcock::proof {

namespace {

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
    return freedom > 0 ? boost::math::gamma_q(freedom / 2.0, statistic / 2) : 1;
}

double chiSquareDeviate(const std::vector<double>& counts, const std::vector<double>& expected) {
    const auto [statistic, freedom] = chiSquare(counts, expected);
    if (std::isinf(statistic) || freedom < 1) return statistic;
    const double variance = 2.0 / (9 * freedom);
    return (std::cbrt(statistic / freedom) - (1 - variance)) / std::sqrt(variance);
}

}  // namespace woodcock::proof
