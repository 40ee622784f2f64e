// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace woodcock {

inline constexpr double pi = 3.14159265358979323846;

/// Three components; arithmetic is component-wise.
template <class T>
struct Vec3 {
    T x{}, y{}, z{};

    constexpr T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
    constexpr T operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }

    constexpr Vec3 operator-() const { return {-x, -y, -z}; }
    constexpr Vec3 operator+(Vec3 b) const { return {x + b.x, y + b.y, z + b.z}; }
    constexpr Vec3 operator-(Vec3 b) const { return {x - b.x, y - b.y, z - b.z}; }
    constexpr Vec3 operator*(Vec3 b) const { return {x * b.x, y * b.y, z * b.z}; }
    constexpr Vec3 operator*(T s) const { return {x * s, y * s, z * s}; }
    constexpr Vec3 operator/(T s) const { return {x / s, y / s, z / s}; }
    constexpr Vec3& operator+=(Vec3 b) { return *this = *this + b; }
    constexpr bool operator==(const Vec3&) const = default;

    template <class U>
    constexpr Vec3<U> as() const {
        return {static_cast<U>(x), static_cast<U>(y), static_cast<U>(z)};
    }
};

using Vec3d = Vec3<double>;
using Vec3f = Vec3<float>;
using Vec3i = Vec3<int>;

template <class T>
constexpr T dot(Vec3<T> a, Vec3<T> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec3d a) {
    const double square = dot(a, a);
    if (square > 1e-200 && square < 1e200) return std::sqrt(square);
    return std::hypot(a.x, a.y, a.z);  // neither overflows nor underflows in between
}
inline Vec3d normalize(Vec3d a) { return a * (1 / length(a)); }
template <class T>
constexpr Vec3<T> min(Vec3<T> a, Vec3<T> b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
template <class T>
constexpr Vec3<T> max(Vec3<T> a, Vec3<T> b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
/// The largest integer not above `v`, which must fit an int. Truncation is one instruction;
/// std::floor may be a call.
inline int floorToInt(double v) {
    const int i = static_cast<int>(v);
    return i - (v < i);
}
inline Vec3i floorToInt(Vec3d p) { return {floorToInt(p.x), floorToInt(p.y), floorToInt(p.z)}; }
inline bool isFinite(Vec3d a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// Two unit vectors that complete unit vector `n` to a right-handed orthonormal basis (s, t, n).
/// Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3.
inline void orthonormalBasis(Vec3d n, Vec3d& s, Vec3d& t) {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1.0 / (sign + n.z);
    const double b = n.x * n.y * a;
    s = {1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x};
    t = {b, sign + n.y * n.y * a, -n.y};
}

/// Axis-aligned box, empty until something is added to it.
struct Box3d {
    Vec3d lower{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                std::numeric_limits<double>::infinity()};
    Vec3d upper = -lower;

    bool empty() const { return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z); }
    void add(Vec3d p) { lower = min(lower, p), upper = max(upper, p); }
    void add(const Box3d& b) { lower = min(lower, b.lower), upper = max(upper, b.upper); }
    Vec3d size() const { return upper - lower; }
    Vec3d centre() const { return (lower + upper) * 0.5; }
    bool operator==(const Box3d&) const = default;
    bool contains(Vec3d p) const {
        return p.x >= lower.x && p.y >= lower.y && p.z >= lower.z && p.x <= upper.x &&
               p.y <= upper.y && p.z <= upper.z;
    }
    Vec3d corner(int i) const {
        return {i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y, i & 4 ? upper.z : lower.z};
    }
};

/// Integer box, both ends included; empty when a lower bound exceeds its upper one.
struct Box3i {
    Vec3i lower{0, 0, 0}, upper{-1, -1, -1};
    bool empty() const { return lower.x > upper.x || lower.y > upper.y || lower.z > upper.z; }
};

}  // namespace woodcock
