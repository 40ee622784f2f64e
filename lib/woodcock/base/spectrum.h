// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace woodcock {

/// N colour channels, scene-linear. Descriptions and films use Rgb = Spectrum<3>. The path loop
/// uses Spectrum<1> where the medium is grey, whatever the colour of the lights.
template <int N>
struct Spectrum {
    std::array<float, N> c{};

    constexpr Spectrum() = default;
    constexpr explicit Spectrum(float v) { c.fill(v); }
    constexpr Spectrum(float r, float g, float b) requires(N == 3) : c{r, g, b} {}

    constexpr float& operator[](int i) { return c[static_cast<size_t>(i)]; }
    constexpr float operator[](int i) const { return c[static_cast<size_t>(i)]; }
    constexpr bool operator==(const Spectrum&) const = default;

    template <class F>
    static constexpr Spectrum map(F f) {
        Spectrum s;
        for (int i = 0; i < N; ++i) s[i] = f(i);
        return s;
    }
    constexpr Spectrum operator+(Spectrum b) const {
        return map([&](int i) { return (*this)[i] + b[i]; });
    }
    constexpr Spectrum operator-(Spectrum b) const {
        return map([&](int i) { return (*this)[i] - b[i]; });
    }
    constexpr Spectrum operator*(Spectrum b) const {
        return map([&](int i) { return (*this)[i] * b[i]; });
    }
    constexpr Spectrum operator*(float s) const {
        return map([&](int i) { return (*this)[i] * s; });
    }
    constexpr Spectrum& operator+=(Spectrum b) { return *this = *this + b; }
    constexpr Spectrum& operator*=(Spectrum b) { return *this = *this * b; }
    constexpr Spectrum& operator*=(float s) { return *this = *this * s; }

    constexpr float maximum() const { return *std::max_element(c.begin(), c.end()); }
    constexpr float minimum() const { return *std::min_element(c.begin(), c.end()); }
    constexpr float sum() const {
        float s = 0;
        for (float v : c) s += v;
        return s;
    }
    constexpr float mean() const { return sum() / N; }
    bool isFinite() const {
        return std::all_of(c.begin(), c.end(), [](float v) { return std::isfinite(v); });
    }
};

using Rgb = Spectrum<3>;

/// True when all three channels are equal, so that one channel suffices.
constexpr bool isGrey(Rgb v) { return v[0] == v[1] && v[1] == v[2]; }

/// The first N channels of a colour: all three, or the one that stands for a grey.
template <int N>
constexpr Spectrum<N> channels(Rgb v) {
    return Spectrum<N>::map([&](int i) { return v[i]; });
}

}  // namespace woodcock
