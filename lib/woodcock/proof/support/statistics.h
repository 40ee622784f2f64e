// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

namespace woodcock::proof {

/// Probability that chance alone makes counts differ this much from what is expected of them. Cells
/// expected to hold few are pooled. Anything in a cell expected to hold none: 0.
double chiSquareProbability(const std::vector<double>& counts, const std::vector<double>& expected);

/// The same as a normal deviate (Wilson and Hilferty 1931): above 0 where counts differ more than
/// chance makes them, below where they are too even, infinite where the probability is 0.
double chiSquareDeviate(const std::vector<double>& counts, const std::vector<double>& expected);

/// Below this chance, a test with a fixed seed fails: about that of four standard errors.
inline constexpr double leastProbability = 1e-4;

/// Nodes in (-1, 1) and weights of the Gauss-Legendre rule of order n.
std::vector<std::pair<double, double>> gaussLegendre(int n);

/// Integral over [a, b] by that rule.
template <class F>
double integrate(double a, double b, int n, F&& f) {
    double sum = 0;
    for (const auto& [x, w] : gaussLegendre(n)) sum += w * f((a + b) / 2 + (b - a) / 2 * x);
    return sum * (b - a) / 2;
}

}  // namespace woodcock::proof
