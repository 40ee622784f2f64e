// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/oracles/quadrature.h"

#include <boost/math/special_functions/legendre.hpp>

namespace woodcock::oracle {

Quadrature gaussLegendre(std::size_t n) {
    const int order = static_cast<int>(n);
    Quadrature rule{std::vector<double>(n), std::vector<double>(n)};
    // Boost gives the zeros that are not negative, rising.
    const std::vector<double> zeros = boost::math::legendre_p_zeros<double>(order);
    for (std::size_t i = 0; i < zeros.size(); ++i) {
        const double x = zeros[i], slope = boost::math::legendre_p_prime(order, x);
        const std::size_t above = n - zeros.size() + i, below = n - 1 - above;
        rule.nodes[above] = (1 + x) / 2, rule.nodes[below] = (1 - x) / 2;
        rule.weights[above] = rule.weights[below] = 1 / ((1 - x * x) * slope * slope);
    }
    return rule;
}

}  // namespace woodcock::oracle
