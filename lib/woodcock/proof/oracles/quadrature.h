// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "woodcock/base/vec.h"

namespace woodcock::oracle {

struct Quadrature {
    std::vector<double> nodes, weights;
};

/// The n nodes and weights of Gauss-Legendre quadrature on [0, 1], nodes rising: exact for
/// polynomials of degree 2n - 1.
Quadrature gaussLegendre(std::size_t n);

/// Integral of `f` over [a, b], relative error about 1e-13 where f is analytic inside, even if it
/// is crowded or has a logarithm's singularity at an end. Takahasi and Mori's double-exponential
/// rule (1974): `f(x, d)` also gets the distance d from x to the nearer end, without rounding.
template <class F>
double tanhSinh(F f, double a, double b) {
    constexpr int perUnit = 32, reach = 4;  // at t = 4 the ends are 1e-38 away
    const double length = b - a;
    double sum = pi / 4 * f((a + b) / 2, length / 2);
    for (int i = 1; i <= perUnit * reach; ++i) {
        const double t = static_cast<double>(i) / perUnit;
        const double d = 1 / (1 + std::exp(pi * std::sinh(t)));
        sum += pi * std::cosh(t) * d * (1 - d) *
               (f(a + d * length, d * length) + f(b - d * length, d * length));
    }
    return sum / perUnit * length;
}

}  // namespace woodcock::oracle
