// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/oracles/phase_functions.h"

#include <algorithm>
#include <cmath>

#include "woodcock/base/vec.h"
#include "woodcock/proof/oracles/closed_forms.h"
#include "woodcock/proof/oracles/quadrature.h"

namespace woodcock::oracle {

namespace {

/// The integral of f over [a, b], by 16 points.
template <class F>
double integral(double a, double b, F f) {
    static const Quadrature rule = gaussLegendre(16);
    double sum = 0;
    for (std::size_t i = 0; i < rule.nodes.size(); ++i)
        sum += rule.weights[i] * f(a + (b - a) * rule.nodes[i]);
    return sum * (b - a);
}

/// Cosines that crowd at both ends, evenly in the logarithm of the distance to them.
std::vector<double> crowdedCosines() {
    constexpr int perSide = 200;
    constexpr double nearest = 1e-12;
    std::vector<double> cosines{-1, 1, 0};
    for (int i = 0; i < perSide; ++i) {
        const double distance = std::pow(nearest, static_cast<double>(i + 1) / perSide);
        cosines.push_back(1 - distance), cosines.push_back(distance - 1);
    }
    return cosines;
}

}  // namespace

double rayleigh(double cosine) { return 0.75 * (1 + cosine * cosine) / (4 * pi); }

double draine(double cosine, double g, double alpha) {
    return (1 - g * g) / (1 + alpha * (1 + 2 * g * g) / 3) * (1 + alpha * cosine * cosine) /
           (4 * pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

double draineMeanCosine(double g, double alpha) {
    return g * (1 + alpha * (3 + 2 * g * g) / 5) / (1 + alpha * (1 + 2 * g * g) / 3);
}

double twoLobes(double cosine, double g, double g2, double mix) {
    return (1 - mix) * henyeyGreenstein(cosine, g) + mix * henyeyGreenstein(cosine, g2);
}

double mieDroplets(double cosine, double d) {
    const double g1 = std::exp(-0.0990567 / (d - 1.67154));
    const double g2 = std::exp(-2.20679 / (d + 3.91029) - 0.428934);
    const double alpha = std::exp(3.62489 - 8.29288 / (d + 5.52825));
    const double mix = std::exp(-0.599085 / (d - 0.641583) - 0.665888);
    return (1 - mix) * henyeyGreenstein(cosine, g1) + mix * draine(cosine, g2, alpha);
}

double fournierForand(double angle, double ior, double backscatter) {
    const double sine = std::sin(angle / 2), cosine = std::cos(angle);
    const double unit = 4 / (3 * (ior - 1) * (ior - 1));
    const double d90 = unit / 2, d180 = unit, d = unit * sine * sine;
    const double nu = -std::log(2 * backscatter * (d90 - 1) + 1) / std::log(d90);
    const double power = std::pow(d, nu), power180 = std::pow(d180, nu);
    return (nu * (1 - d) - (1 - power) + (d * (1 - power) - nu * (1 - d)) / (sine * sine)) /
               (4 * pi * (1 - d) * (1 - d) * power) +
           (1 - power180) / (16 * pi * (d180 - 1) * power180) * (3 * cosine * cosine - 1);
}

double legendreSeries(double cosine, const std::vector<double>& moments) {
    double sum = 0, before = 0, p = 1;
    for (std::size_t l = 0; l < moments.size(); ++l) {
        const auto n = static_cast<double>(l);
        sum += (2 * n + 1) * moments[l] * p;
        const double next = ((2 * n + 1) * cosine * p - n * before) / (n + 1);
        before = p, p = next;
    }
    return sum / (4 * pi);
}

std::vector<double> legendreMoments(const std::function<double(double)>& phase, std::size_t count) {
    // Twice as many nodes as there are waves, and the peak by panels that crowd.
    std::vector<double> cosines = crowdedCosines(), moments(count);
    for (int i = 1; i < 64; ++i) cosines.push_back(std::cos(pi * i / 64));
    std::sort(cosines.begin(), cosines.end());
    const Quadrature rule = gaussLegendre(24);
    for (std::size_t k = 0; k + 1 < cosines.size(); ++k) {
        const double width = cosines[k + 1] - cosines[k];
        for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
            const double cosine = cosines[k] + width * rule.nodes[i];
            const double weight = 2 * pi * width * rule.weights[i] * phase(cosine);
            double before = 0, p = 1;
            for (std::size_t l = 0; l < count; ++l) {
                const auto n = static_cast<double>(l);
                moments[l] += weight * p;
                const double next = ((2 * n + 1) * cosine * p - n * before) / (n + 1);
                before = p, p = next;
            }
        }
    }
    return moments;
}

TurnDistribution::TurnDistribution(std::function<double(double)> density,
                                   const std::vector<double>& kinks)
    : density_(std::move(density)), cosines_(crowdedCosines()), parts_{0} {
    cosines_.insert(cosines_.end(), kinks.begin(), kinks.end());
    std::sort(cosines_.begin(), cosines_.end());
    cosines_.erase(std::unique(cosines_.begin(), cosines_.end()), cosines_.end());
    for (std::size_t i = 0; i + 1 < cosines_.size(); ++i) {
        const double a = cosines_[i], b = cosines_[i + 1];
        parts_.push_back(parts_.back() + 2 * pi * integral(a, b, density_));
        meanCosine_ += 2 * pi * integral(a, b, [&](double c) { return c * density_(c); });
    }
}

double TurnDistribution::operator()(double cosine) const {
    const auto above = std::upper_bound(cosines_.begin() + 1, cosines_.end() - 1, cosine);
    const auto i = static_cast<std::size_t>(above - cosines_.begin());
    return (parts_[i - 1] + 2 * pi * integral(cosines_[i - 1], cosine, density_)) / total();
}

}  // namespace woodcock::oracle
