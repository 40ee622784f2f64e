// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/oracles/adding_doubling.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "woodcock/base/error.h"
#include "woodcock/base/vec.h"
#include "woodcock/proof/oracles/quadrature.h"

namespace woodcock::oracle {

namespace {

using Values = std::vector<double>;
using Matrix = Eigen::MatrixXd;

Matrix zeros(std::size_t n) {
    return Matrix::Zero(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
}

auto diagonal(const Values& values) {
    return Eigen::Map<const Eigen::VectorXd>(values.data(),
                                             static_cast<Eigen::Index>(values.size()))
        .asDiagonal();
}

/// Each column times its factor.
Matrix scaleColumns(const Matrix& a, const Values& factors) { return a * diagonal(factors); }

Matrix oneMinus(const Matrix& a) { return Matrix::Identity(a.rows(), a.cols()) - a; }

/// The X of a X = b.
Matrix solve(const Matrix& a, const Matrix& b) { return a.partialPivLu().solve(b); }

Values rowSums(const Matrix& a) {
    const Eigen::VectorXd sums = a.rowwise().sum();
    return {sums.begin(), sums.end()};
}

double square(double x) { return x * x; }

/// Cosine on the dense side of a boundary, of light at `mu` on the thin side (Snell).
double refracted(double mu, double index) { return std::sqrt(1 - (1 - mu * mu) / (index * index)); }

/// The directions of one hemisphere inside the slab. The integral of 2 mu f(mu) is
/// sum(flux[i] f(mu[i])). The last ones are only looked at: their flux is 0.
struct Directions {
    Values mu, flux;
    Values boundaryReflectance;   ///< of the slab's faces
    std::vector<bool> canEscape;  ///< not totally reflected

    void add(double cosine, double weight, double reflectance, bool escapes) {
        mu.push_back(cosine), flux.push_back(2 * cosine * weight);
        boundaryReflectance.push_back(reflectance), canEscape.push_back(escapes);
    }
};

Directions directions(const Values& asked, std::size_t nodes, const Slab& slab) {
    const double index = slab.refractiveIndex;
    double depth = 0;
    for (const Layer& l : slab.layers) depth += l.opticalDepth;
    Directions all;
    // Light that can escape is sampled uniformly outside, where Fresnel's terms are smooth. An
    // almost clear slab traps no light; without absorption the amount of trapped light would be
    // undefined.
    const std::size_t escaping = index == 1 || depth < 1e-12 ? nodes : nodes / 2;
    const Quadrature outside = gaussLegendre(escaping);
    for (std::size_t i = 0; i < escaping; ++i) {
        const double mu = outside.nodes[i], inside = refracted(mu, index);
        all.add(inside, outside.weights[i] * mu / (inside * index * index),
                fresnelReflectance(mu, index), true);
    }
    const double critical = refracted(0, index);
    const Quadrature trapped = gaussLegendre(nodes - escaping);
    for (std::size_t i = 0; i < nodes - escaping; ++i)
        all.add(critical * trapped.nodes[i], critical * trapped.weights[i], 1, false);
    for (const double mu : asked)
        all.add(refracted(mu, index), 0, fresnelReflectance(mu, index), true);
    return all;
}

/// The phase function between the directions of a hemisphere.
struct Redistribution {
    Matrix forward, backward;  ///< to the same hemisphere and to the opposite one
    /// The scattered light from each direction that the quadrature misses (or counts too much). It
    /// is the tip of the peak, and counts as light that goes straight on.
    Values unresolved;
};

/// P_l(mu) for all l < count.
Values legendre(double mu, std::size_t count) {
    Values p{1, mu};
    for (std::size_t l = 2; l < count; ++l) {
        const auto n = static_cast<double>(l);
        p.push_back(((2 * n - 1) * mu * p[l - 1] - (n - 1) * p[l - 2]) / n);
    }
    return p;
}

/// Averaged over azimuth, P_l of the angle between two directions is the product of P_l of both.
void fillFromMoments(Redistribution& r, const Directions& d, const Values& moments) {
    const std::size_t n = d.mu.size();
    std::vector<Values> p;
    for (const double mu : d.mu) p.push_back(legendre(mu, moments.size()));
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
            for (std::size_t l = 0; l < moments.size(); ++l) {
                const double term =
                    (2 * static_cast<double>(l) + 1) * moments[l] * p[i][l] * p[j][l];
                r.forward(i, j) += term;
                r.backward(i, j) += l % 2 == 0 ? term : -term;
            }
}

Redistribution redistribution(const Directions& d, const Layer& layer) {
    const std::size_t n = d.mu.size();
    const double g = layer.g;
    Redistribution r{zeros(n), zeros(n), Values(n, 1)};
    if (!layer.moments.empty()) fillFromMoments(r, d, layer.moments);
    for (std::size_t i = 0; i < n && layer.moments.empty(); ++i)
        for (std::size_t j = 0; j <= i; ++j) {
            r.forward(i, j) = r.forward(j, i) = azimuthMeanOfHenyeyGreenstein(d.mu[i], d.mu[j], g);
            r.backward(i, j) = r.backward(j, i) =
                azimuthMeanOfHenyeyGreenstein(d.mu[i], -d.mu[j], g);
        }
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
            r.unresolved[i] -= d.flux[j] / (4 * d.mu[j]) * (r.forward(i, j) + r.backward(i, j));
    return r;
}

/// A homogeneous layer. Radiance out = (R flux) in, or (straight + T flux) in. The straight part is
/// kept separate, for the relative accuracy of T in thin layers.
struct Uniform {
    Values straight;
    Matrix R, T;
};

/// The thin layer, by the implicit midpoint rule ("diamond initialisation", Wiscombe 1976): errors
/// of order (depth / mu)^2, energy conserved exactly. With x = depth / (2 mu), and G+- the
/// scattering of sums and differences of up and down, T +- R = (1 + x - G)^-1 (1 - x + G).
Uniform thinLayer(const Directions& d, const Redistribution& p, double albedo, double depth) {
    const std::size_t n = d.mu.size();
    Uniform layer{Values(n), zeros(n), zeros(n)};
    Values x(n);
    for (std::size_t i = 0; i < n; ++i) {
        x[i] = depth * (1 - albedo * p.unresolved[i]) / (2 * d.mu[i]);
        layer.straight[i] = (1 - x[i]) / (1 + x[i]);
    }
    for (const int sign : {1, -1}) {
        Matrix left = zeros(n), right = zeros(n);
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j) {
                const double G = albedo * depth / (8 * d.mu[i] * d.mu[j]) *
                                 (p.forward(i, j) + sign * p.backward(i, j));
                left(i, j) = -G * d.flux[j];
                right(i, j) = 2 * G / (1 + x[j]);
            }
            left(i, i) += 1 + x[i];
        }
        const Matrix scattered = solve(left, right);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j) {
                layer.T(i, j) += scattered(i, j) / 2;
                layer.R(i, j) += sign * scattered(i, j) / 2;
            }
    }
    return layer;
}

/// Two equal layers on one another. Lit from both sides with equal (+) or opposite (-) light, the
/// light between them is m+- = (1 -+ R)^-1 T, and T m+- is what each sends through the other.
Uniform doubled(const Uniform& layer, const Directions& d) {
    const std::size_t n = d.mu.size();
    const Matrix R = scaleColumns(layer.R, d.flux), T = scaleColumns(layer.T, d.flux);
    Uniform result = layer;
    result.T = zeros(n);
    for (const int sign : {1, -1}) {
        Matrix left = zeros(n), right = zeros(n);
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j) {
                left(i, j) = -sign * R(i, j);
                right(i, j) = layer.T(i, j) + sign * layer.R(i, j) * layer.straight[j];
            }
            left(i, i) += 1;
        }
        const Matrix between = solve(left, right);
        const Matrix scattered = T * between;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j) {
                const double through = layer.straight[i] * between(i, j) +
                                       layer.T(i, j) * layer.straight[j] + scattered(i, j);
                result.T(i, j) += through / 2;
                result.R(i, j) += sign * through / 2;
            }
    }
    return result;
}

/// A stack of layers as operators on the radiance in each direction.
struct Stack {
    Matrix reflectAbove, transmitDown, reflectBelow, transmitUp;
};

Stack stackOf(const Layer& layer, const Directions& d) {
    const double grazing = *std::min_element(d.mu.begin(), d.mu.end());
    int doublings = 0;
    double depth = layer.opticalDepth;
    for (; depth > 0x1p-12 * grazing; depth /= 2) ++doublings;

    const Redistribution p = redistribution(d, layer);
    Uniform uniform = thinLayer(d, p, layer.albedo, depth);
    for (int k = 1; k <= doublings; ++k) {
        uniform = doubled(uniform, d);
        // thinLayer's (1 - x) / (1 + x) to the power 2^k, not squared again and again
        for (std::size_t i = 0; i < d.mu.size(); ++i) {
            const double x = depth * (1 - layer.albedo * p.unresolved[i]) / (2 * d.mu[i]);
            uniform.straight[i] = std::exp(-std::ldexp(std::atanh(x), k + 1));
        }
    }
    const Matrix R = scaleColumns(uniform.R, d.flux);
    const Matrix T = Matrix(diagonal(uniform.straight)) + scaleColumns(uniform.T, d.flux);
    return {R, T, R, T};
}

/// A face with refraction. Radiance is counted divided by the square of the refractive index, which
/// the passage leaves alone, so both ways are alike.
Stack boundary(const Directions& d) {
    const Matrix R = Matrix(diagonal(d.boundaryReflectance));
    return {R, oneMinus(R), R, oneMinus(R)};
}

Stack added(const Stack& upper, const Stack& lower) {
    const Matrix down =
        solve(oneMinus(upper.reflectBelow * lower.reflectAbove), upper.transmitDown);
    const Matrix up = solve(oneMinus(lower.reflectAbove * upper.reflectBelow), lower.transmitUp);
    return {upper.reflectAbove + upper.transmitUp * (lower.reflectAbove * down),
            lower.transmitDown * down,
            lower.reflectBelow + lower.transmitDown * (upper.reflectBelow * up),
            upper.transmitUp * up};
}

/// What leaves a face under environments of radiance 1 on its side and on the other.
Face faceOf(const Matrix& reflect, const Matrix& transmit, const Directions& d, double index,
            std::size_t asked) {
    const Values R = rowSums(reflect), T = rowSums(transmit);
    Face face{Values(R.end() - static_cast<std::ptrdiff_t>(asked), R.end()),
              Values(T.end() - static_cast<std::ptrdiff_t>(asked), T.end()), 0, 0};
    for (std::size_t i = 0; i < d.mu.size(); ++i) {
        if (!d.canEscape[i]) continue;
        face.whiteSkyReflectance += index * index * d.flux[i] * R[i];
        face.whiteSkyTransmittance += index * index * d.flux[i] * T[i];
    }
    return face;
}

void check(const Slab& slab, const Values& mu, std::size_t nodes) {
    if (nodes < 2) throw usageError("{} directions per hemisphere; at least 2 are needed", nodes);
    if (!(slab.refractiveIndex >= 1 && std::isfinite(slab.refractiveIndex)))
        throw usageError("refractive index {}; must be 1 or more", slab.refractiveIndex);
    for (const double m : mu)
        if (!(m > 0 && m <= 1)) throw usageError("cosine {}; must be in (0, 1]", m);
    for (const Layer& l : slab.layers) {
        if (!(l.opticalDepth >= 0 && std::isfinite(l.opticalDepth)))
            throw usageError("optical depth {}; must be 0 or more and finite", l.opticalDepth);
        if (!(l.albedo >= 0 && l.albedo <= 1))
            throw usageError("albedo {}; must be in [0, 1]", l.albedo);
        if (!(std::abs(l.g) < 1)) throw usageError("g {}; must be in (-1, 1)", l.g);
        if (!l.moments.empty() && !(std::abs(l.moments[0] - 1) < 1e-9))
            throw usageError("moment 0 is {}; must be 1", l.moments[0]);
    }
}

}  // namespace

double azimuthMeanOfHenyeyGreenstein(double to, double from, double g) {
    if (g == 0) return 1;
    if (g < 0) return azimuthMeanOfHenyeyGreenstein(-to, from, -g);
    // 1 + g^2 - 2 g cos runs between these two as azimuth does; an elliptic integral is left.
    const double a = std::acos(to), b = std::acos(from);
    const double least = square(1 - g) + 4 * g * square(std::sin((a - b) / 2));
    const double most = square(1 - g) + 4 * g * square(std::sin((a + b) / 2));
    const double k = std::sqrt(std::max(0.0, most - least) / most);
    return 2 / pi * (1 - g) * (1 + g) * std::comp_ellint_2(k) / (least * std::sqrt(most));
}

double fresnelReflectance(double mu, double index) {
    if (index == 1) return 0;
    const double inside = refracted(mu, index);
    const double s = (mu - index * inside) / (mu + index * inside);
    const double p = (inside - index * mu) / (inside + index * mu);
    return (s * s + p * p) / 2;
}

SlabAnswer solveSlab(const Slab& slab, const std::vector<double>& mu, std::size_t nodes) {
    check(slab, mu, nodes);
    const double index = slab.refractiveIndex;
    const Directions d = directions(mu, nodes, slab);
    const Stack face = boundary(d);
    Stack all = face;
    for (const Layer& layer : slab.layers) all = added(all, stackOf(layer, d));
    if (index != 1) all = added(all, face);
    return {faceOf(all.reflectAbove, all.transmitUp, d, index, mu.size()),
            faceOf(all.reflectBelow, all.transmitDown, d, index, mu.size())};
}

}  // namespace woodcock::oracle
