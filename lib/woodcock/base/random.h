// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace woodcock {

/// A bijection of 64-bit words that leaves no visible structure: the finalizer of Steele et al.
/// 2014, "Fast Splittable Pseudorandom Number Generators", with the constants of Stafford's
/// variant 13.
constexpr std::uint64_t mixBits(std::uint64_t v) {
    v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9u;
    v = (v ^ (v >> 27)) * 0x94d049bb133111ebu;
    return v ^ (v >> 31);
}

template <class... A>
constexpr std::uint64_t hashOf(std::uint64_t first, A... rest) {
    std::uint64_t h = mixBits(first + 0x9e3779b97f4a7c15u);
    ((h = mixBits(h ^ (static_cast<std::uint64_t>(rest) + 0x9e3779b97f4a7c15u))), ...);
    return h;
}

/// SplitMix64. Its state is one word, so every path has a stream of its own, which depends on its
/// pixel and sample only.
class RandomStream {
public:
    explicit RandomStream(std::uint64_t name = 0) : state_(name) {}

    std::uint64_t bits() { return mixBits(state_ += 0x9e3779b97f4a7c15u); }
    /// Uniform in (0, 1], multiples of 2^-53: its logarithm is finite.
    double uniformOpenLow() { return static_cast<double>((bits() >> 11) + 1) * 0x1p-53; }
    /// Uniform in [0, 1), multiples of 2^-53.
    double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

private:
    std::uint64_t state_;
};

}  // namespace woodcock
