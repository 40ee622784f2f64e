// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace woodcock::bake {

/// An interval of values, both ends included.
struct Interval {
    double lower = -std::numeric_limits<double>::infinity();
    double upper = std::numeric_limits<double>::infinity();

    static Interval of(double v) { return {v, v}; }
    static Interval around(double centre, double radius) {
        return {centre - radius, centre + radius};
    }
    bool isConstant() const { return lower == upper; }
    bool contains(double v) const { return v >= lower && v <= upper; }
    bool operator==(const Interval&) const = default;

    Interval operator+(Interval b) const { return {lower + b.lower, upper + b.upper}; }
    Interval operator-(Interval b) const { return {lower - b.upper, upper - b.lower}; }
    Interval operator*(double s) const {
        return s < 0 ? Interval{upper * s, lower * s} : Interval{lower * s, upper * s};
    }
    Interval operator*(Interval b) const {
        const double p[]{product(lower, b.lower), product(lower, b.upper), product(upper, b.lower),
                         product(upper, b.upper)};
        return {*std::min_element(p, p + 4), *std::max_element(p, p + 4)};
    }

private:
    /// 0 x infinity is 0 here: an infinite end stands for any number.
    static double product(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }
};

inline Interval min(Interval a, Interval b) {
    return {std::min(a.lower, b.lower), std::min(a.upper, b.upper)};
}
inline Interval max(Interval a, Interval b) {
    return {std::max(a.lower, b.lower), std::max(a.upper, b.upper)};
}
inline Interval clamp(Interval a, double lower, double upper) {
    return {std::clamp(a.lower, lower, upper), std::clamp(a.upper, lower, upper)};
}
/// The intersection: a function's own range tightens its bounds.
inline Interval intersect(Interval a, Interval b) {
    return {std::max(a.lower, b.lower), std::min(a.upper, b.upper)};
}
inline Interval abs(Interval a) {
    if (a.lower >= 0) return a;
    if (a.upper <= 0) return {-a.upper, -a.lower};
    return {0, std::max(-a.lower, a.upper)};
}
/// The image under a function that is nowhere decreasing.
template <class F>
Interval rising(Interval a, F f) {
    return {f(a.lower), f(a.upper)};
}

}  // namespace woodcock::bake
