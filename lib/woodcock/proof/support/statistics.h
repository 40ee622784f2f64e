// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "woodcock/proof/oracles/quadrature.h"

namespace woodcock::proof {

/// Probability that chance alone makes counts differ this much from what is expected of them. Cells
/// expected to hold few are pooled. Anything in a cell expected to hold none: 0.
double chiSquareProbability(const std::vector<double>& counts, const std::vector<double>& expected);

/// The same as a normal deviate (Wilson and Hilferty 1931): above 0 where counts differ more than
/// chance makes them, below where they are too even, infinite where the probability is 0.
double chiSquareDeviate(const std::vector<double>& counts, const std::vector<double>& expected);

/// Below this chance, a test with a fixed seed fails: about that of four standard errors.
inline constexpr double leastProbability = 1e-4;

/// Integral over [a, b] by the Gauss-Legendre rule of order n.
template <class F>
double integrate(double a, double b, std::size_t n, F&& f) {
    const oracle::Quadrature rule = oracle::gaussLegendre(n);
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += rule.weights[i] * f(a + (b - a) * rule.nodes[i]);
    return sum * (b - a);
}

}  // namespace woodcock::proof
