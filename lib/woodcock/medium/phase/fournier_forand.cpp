// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/phase/fournier_forand.h"

#include "woodcock/base/error.h"

namespace woodcock::medium {

namespace {

constexpr double innermost = 1e-10;  // x of 4 arc seconds

/// nu of Mobley, Sundman and Boss 2002, eq. 10, solved for it.
double slope(double delta90, double backscatter) {
    const double excess = delta90 - 1;
    if (excess == 0) return -2 * backscatter;
    return -std::log1p(2 * backscatter * excess) / std::log1p(excess);
}

/// The root of a rising function in [least, most], where `start` lies as well. f(y) returns its
/// value and its derivative.
template <class F>
double rootByNewton(double least, double most, double start, F f) {
    double y = start;
    for (int i = 0; i < 200; ++i) {
        const auto [value, derivative] = f(y);
        (value < 0 ? least : most) = y;
        double next = y - value / derivative;
        if (!(next >= least && next <= most)) next = (least + most) / 2;
        const double change = std::abs(next - y);
        y = next;
        if (change <= 1e-9) break;  // and this step left its square
    }
    return y;
}

}  // namespace

FournierForand::FournierForand(double ior, double backscatter) {
    if (!(ior > 1 && ior <= largestIor))
        throw inputError("ior is {}; it must lie above 1, and at most at {}", ior, largestIor);
    if (!(backscatter > 0 && backscatter < 0.5))
        throw inputError("backscatter is {}; it must lie strictly between 0 and 0.5", backscatter);
    delta_ = 4 / (3 * (ior - 1) * (ior - 1));
    nu_ = slope(delta_ / 2, backscatter);
    const double p = std::pow(delta_, nu_);
    back_ = (1 - p) / ((delta_ - 1) * p);
    peak_ = cdf(innermost);

    // The mean of 1 - 2x is 2 x integral of the CDF - 1; by Simpson's rule in log(x).
    constexpr int intervals = 4096;
    const double from = std::log(innermost), step = -from / intervals;
    double sum = 0;
    for (int i = 0; i <= intervals; ++i) {
        const double x = std::exp(from + i * step);
        sum += cdf(x) * x * (i == 0 || i == intervals ? 1 : i % 2 ? 4 : 2);
    }
    // Never 1, which nothing that scatters back may have.
    meanCosine_ = std::min(2 * (sum * step / 3 + peak_ * innermost / 2) - 1, 1 - 1e-12);

    starts_[0] = from, starts_[steps] = 0;
    for (std::size_t k = 1; k < steps; ++k) {
        const double u = static_cast<double>(k) / steps;
        starts_[k] = u <= peak_ ? from : rootByNewton(from, 0, from / 2, [&](double y) {
            const double x = std::exp(y);
            return std::pair(cdf(x) - u, 4 * pi * x * formula(x));
        });
    }
}

double FournierForand::formula(double x) const {
    const double delta = delta_ * x, h = 1 - delta, p = std::pow(delta, nu_);
    // (nu h - (1 - p)) / h^2 and (delta (1 - p) - nu h) / h^2. Near delta = 1 by the binomial
    // series of p = (1 - h)^nu, as both numerators vanish there like h^2.
    double even = 0, steep = 0;
    if (std::abs(h) < 0.05) {
        double coefficient = nu_, power = 1;  // binomial(nu, k - 1), (-h)^(k - 2)
        for (int k = 2; k < 14; ++k) {
            const double next = coefficient * (nu_ - k + 1) / k;
            even += next * power;
            steep -= (next + coefficient) * power;
            coefficient = next, power *= -h;
        }
    } else {
        even = (nu_ * h - (1 - p)) / (h * h);
        steep = (delta * (1 - p) - nu_ * h) / (h * h);
    }
    const double cosine = 1 - 2 * x;
    return (even + steep / x) / (4 * pi * p) + back_ / (16 * pi) * (3 * cosine * cosine - 1);
}

double FournierForand::cdf(double x) const {
    if (x >= 1) return 1;
    const double l = std::log(delta_ * x);
    // (1 - delta^k) / (1 - delta)
    const auto ratio = [&](double k) { return l == 0 ? k : std::expm1(k * l) / std::expm1(l); };
    return (ratio(nu_ + 1) - x * ratio(nu_)) * std::exp(-nu_ * l) +
           back_ / 2 * x * (1 - x) * (1 - 2 * x);
}

double FournierForand::valueAt(double x) const {
    return x < innermost ? peak_ / (4 * pi * innermost) : formula(std::min(x, 1.0));
}

Turn FournierForand::sample(double u) const {
    double x;
    if (u < peak_) {
        x = innermost * u / peak_;
    } else {
        const auto k = std::min(static_cast<std::size_t>(u * steps), steps - 1);
        const double least = starts_[k], most = starts_[k + 1];
        const double part = u * steps - static_cast<double>(k);
        x = std::exp(rootByNewton(least, most, least + part * (most - least), [&](double y) {
            const double at = std::exp(y);
            return std::pair(cdf(at) - u, 4 * pi * at * formula(at));
        }));
    }
    x = std::min(x, 1.0);
    return {2 * x, 2 - 2 * x};
}

}  // namespace woodcock::medium
