// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/oracles/quadrature.h"

namespace woodcock::oracle {

Quadrature gaussLegendre(std::size_t n) {
    Quadrature rule{std::vector<double>(n), std::vector<double>(n)};
    for (std::size_t i = 0; i < n; ++i) {
        double x = -std::cos(pi * (static_cast<double>(i) + 0.75) / (static_cast<double>(n) + 0.5));
        double slope = 0;
        for (int iteration = 0; iteration < 10; ++iteration) {
            double p = 1, before = 0;
            for (std::size_t k = 1; k <= n; ++k) {
                const auto l = static_cast<double>(k);
                const double next = ((2 * l - 1) * x * p - (l - 1) * before) / l;
                before = p, p = next;
            }
            slope = static_cast<double>(n) * (before - x * p) / (1 - x * x);
            x -= p / slope;
        }
        rule.nodes[i] = (1 + x) / 2;
        rule.weights[i] = 1 / ((1 - x * x) * slope * slope);
    }
    return rule;
}

}  // namespace woodcock::oracle
