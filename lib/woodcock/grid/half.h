// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

#ifdef __F16C__
#include <immintrin.h>
#endif

namespace woodcock::grid {

inline constexpr float largestHalf = 65504.0f;

/// IEEE half to float, for finite values: exact, denormals included.
inline float decodeHalf(std::uint16_t h) {
#ifdef __F16C__
    return _cvtsh_ss(h);
#else
    const std::uint32_t magnitude = (h & 0x7fffu) << 13;
    const float v = std::bit_cast<float>(magnitude) * 0x1p112f;
    return h & 0x8000u ? -v : v;
#endif
}

/// The half nearest to `v` (to the even one of two), for |v| <= largestHalf. Without branches, so
/// that a loop over it becomes vector code on any processor.
inline std::uint16_t encodeHalf(float v) {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(v);
    const std::uint32_t magnitude = bits & 0x7fffffffu, sign = (bits & 0x80000000u) >> 16;
    // 13 digits go; the exponent's bias falls by 112.
    const std::uint32_t normal =
        (magnitude + 0xfffu + ((magnitude >> 13) & 1u) - (112u << 23)) >> 13;
    // Floats around one half have steps of 2^-24, as denormal halves do.
    const std::uint32_t denormal =
        std::bit_cast<std::uint32_t>(std::bit_cast<float>(magnitude) + 0.5f) -
        std::bit_cast<std::uint32_t>(0.5f);
    constexpr std::uint32_t smallestNormal = 0x38800000u;  // 2^-14
    return static_cast<std::uint16_t>(sign | (magnitude < smallestNormal ? denormal : normal));
}

/// True for what a half holds without rounding; false for NaN and infinities.
inline bool isExactAsHalf(float v) {
    const std::uint32_t magnitude = std::bit_cast<std::uint32_t>(v) & 0x7fffffffu;
    constexpr std::uint32_t smallestNormal = 0x38800000u, largest = 0x477fe000u;  // 2^-14, 65504
    const float m = std::bit_cast<float>(magnitude);
    const unsigned asNormal = static_cast<unsigned>(magnitude <= largest) &
                              static_cast<unsigned>((magnitude & 0x1fffu) == 0);
    const auto asDenormal = static_cast<unsigned>((m + 0.5f) - 0.5f == m);  // as in encodeHalf()
    return (magnitude < smallestNormal ? asDenormal : asNormal) != 0;
}

}  // namespace woodcock::grid
