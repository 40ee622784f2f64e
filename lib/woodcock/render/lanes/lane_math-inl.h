// SPDX-License-Identifier: Apache-2.0
// Compiled once for each set of instructions: see trace_lanes.cpp.
#if defined(WOODCOCK_LANE_MATH) == defined(HWY_TARGET_TOGGLE)
#ifdef WOODCOCK_LANE_MATH
#undef WOODCOCK_LANE_MATH
#else
#define WOODCOCK_LANE_MATH
#endif

#include <hwy/highway.h>

#include <cstdint>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace woodcock::render::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Vectors of floats and of integers, a path in each lane. Everything is made of additions,
// multiplications, divisions and square roots, which all sets of instructions round alike. There
// are no fused operations. So a path has the same bits in a vector of any length.

inline constexpr hn::ScalableTag<float> lanesF;
inline constexpr hn::ScalableTag<std::int32_t> lanesI;
inline constexpr hn::ScalableTag<std::uint32_t> lanesU;
using F = hn::Vec<decltype(lanesF)>;
using I = hn::Vec<decltype(lanesI)>;
using U = hn::Vec<decltype(lanesU)>;

inline F all(float v) { return hn::Set(lanesF, v); }

/// One round of Threefry, and of every fourth the injection of the key.
template <int Round>
inline void threefryRound(const U keys[5], U words[4]) {
    constexpr int turns[8][2] = {{10, 26}, {11, 21}, {13, 27}, {23, 5},
                                 {6, 20},  {17, 11}, {25, 10}, {18, 20}};
    constexpr int a = Round % 2 == 0 ? 1 : 3, b = 4 - a;
    words[0] = words[0] + words[a];
    words[a] = hn::Xor(hn::RotateRight<32 - turns[Round % 8][0]>(words[a]), words[0]);
    words[2] = words[2] + words[b];
    words[b] = hn::Xor(hn::RotateRight<32 - turns[Round % 8][1]>(words[b]), words[2]);
    if constexpr (Round % 4 == 3) {
        constexpr int injection = Round / 4 + 1;
        for (int i = 0; i < 4; ++i) words[i] = words[i] + keys[(injection + i) % 5];
        words[3] = words[3] + hn::Set(lanesU, injection);
    }
}

/// Four random words of each lane: Threefry-4x32, a function of a key and a counter. Salmon et al.
/// 2011, "Parallel Random Numbers: As Easy as 1, 2, 3": with 12 rounds it passes all of BigCrush
/// (table 2).
template <int Rounds = 12>
inline void threefry(const U key[4], const U counter[4], U words[4]) {
    const U keys[5] = {key[0], key[1], key[2], key[3],
                       hn::Xor(hn::Xor(hn::Xor(key[0], key[1]), hn::Xor(key[2], key[3])),
                               hn::Set(lanesU, 0x1BD11BDAu))};
    for (int i = 0; i < 4; ++i) words[i] = counter[i] + keys[i];
    [&]<int... Round>(std::integer_sequence<int, Round...>) {
        (threefryRound<Round>(keys, words), ...);
    }
    (std::make_integer_sequence<int, Rounds>());
}

/// Uniform in [0, 1), multiples of 2^-24.
inline F uniform(U bits) {
    return hn::ConvertTo(lanesF, hn::BitCast(lanesI, hn::ShiftRight<8>(bits))) * all(0x1p-24f);
}

/// Natural logarithm of normal positive numbers, to 3 ulp (near 1 as well): the exponent, and the
/// series of the area tangent for what is left.
inline F logarithm(F x) {
    const I bits = hn::BitCast(lanesI, x);
    // The exponent such that the rest is in [sqrt(1/2), sqrt(2)).
    const I exponent = hn::ShiftRight<23>(bits - hn::Set(lanesI, 0x3f3504f3));
    const F rest = hn::BitCast(lanesF, bits - hn::ShiftLeft<23>(exponent));
    const F s = (rest - all(1)) / (rest + all(1)), s2 = s * s;
    const F series =
        all(1) +
        s2 * (all(1.0f / 3) + s2 * (all(1.0f / 5) + s2 * (all(1.0f / 7) + s2 * all(1.0f / 9))));
    return hn::ConvertTo(lanesF, exponent) * all(0.693147181f) + all(2) * s * series;
}

/// exp(-x) for x of at least 0, to 3 + 1.5 x ulp; 0 beyond 87.
inline F decay(F x) {
    const F y = hn::Min(x, all(87.3f)) * all(-1.44269504f), whole = hn::Round(y);
    const F r = (y - whole) * all(0.693147181f);
    const F series =
        all(1) +
        r * (all(1) + r * (all(0.5f) +
                           r * (all(1.0f / 6) + r * (all(1.0f / 24) + r * (all(1.0f / 120) +
                                                                           r * all(1.0f / 720))))));
    const I power = hn::ShiftLeft<23>(hn::ConvertTo(lanesI, whole) + hn::Set(lanesI, 127));
    return hn::IfThenZeroElse(x > all(87), series * hn::BitCast(lanesF, power));
}

/// An optical depth by an exponential distribution: -log of a number uniform in (0, 1], of 32 bits.
/// It is at most 22.9, beyond which 1e-10 of all lie.
inline F drawDepth(U bits) {
    const F low = hn::ConvertTo(lanesF, hn::BitCast(lanesI, hn::And(bits, hn::Set(lanesU, 255u))));
    return all(0) - logarithm(uniform(bits) + (low + all(0.5f)) * all(0x1p-32f));
}

/// Sine and cosine of 2 pi u, u in [0, 1), to 2e-7: by the nearest quarter of a turn, and Taylor's
/// series of the rest.
inline void sineAndCosine(F u, F& sine, F& cosine) {
    const F quarter = hn::Round(u * all(4));
    const F x = (u - quarter * all(0.25f)) * all(6.283185307f), x2 = x * x;
    const F s =
        x * (all(1) +
             x2 * (all(-1.0f / 6) +
                   x2 * (all(1.0f / 120) + x2 * (all(-1.0f / 5040) + x2 * all(1.0f / 362880)))));
    const F c =
        all(1) +
        x2 * (all(-0.5f) +
              x2 * (all(1.0f / 24) + x2 * (all(-1.0f / 720) +
                                           x2 * (all(1.0f / 40320) + x2 * all(-1.0f / 3628800)))));
    const I turn = hn::ConvertTo(lanesI, quarter);
    const auto bit = [&](int b) {
        return hn::RebindMask(lanesF, hn::Ne(hn::And(turn, hn::Set(lanesI, b)), hn::Zero(lanesI)));
    };
    const auto odd = bit(1), back = bit(2);
    const F first = hn::IfThenElse(odd, c, s), second = hn::IfThenElse(odd, all(0) - s, c);
    sine = hn::IfThenElse(back, all(0) - first, first);
    cosine = hn::IfThenElse(back, all(0) - second, second);
}

/// Three numbers for each lane.
struct V3 {
    F x, y, z;
};
inline F dot(const V3& a, const V3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline V3 operator+(const V3& a, const V3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline V3 operator-(const V3& a, const V3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline V3 operator*(const V3& a, F s) { return {a.x * s, a.y * s, a.z * s}; }

/// Unit vectors, Henyey-Greenstein with mean cosine `g` around them, by u in [0, 1)^2; and the
/// density per steradian. As sampleHenyeyGreenstein().
inline V3 sampleHenyeyGreenstein(const V3& forward, F g, F u0, F u1, F& density) {
    const F one = all(1), half = all(0.5f);
    const F s = u0 + u0 - one, q = one + g * s, inverse = one / (q * q);
    const F less = one - g, more = one + g;
    const F below = (one - s) * less * less * (one + half * g + half * g * s) * inverse;
    const F above = (one + s) * more * more * (one - half * g + half * g * s) * inverse;
    const F sine = hn::Sqrt(hn::Max(hn::Zero(lanesF), below * above));
    const F cosine = hn::IfThenElse(below < above, one - below, above - one);
    const F width = less * more;
    density = q * q * q / (all(12.5663706f) * width * width);
    // A basis around them: Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
    const F sign = hn::CopySign(one, forward.z);
    const F a = all(-1) / (sign + forward.z), b = forward.x * forward.y * a;
    F sineAround, cosineAround;
    sineAndCosine(u1, sineAround, cosineAround);
    const F x = sine * cosineAround, y = sine * sineAround;
    const V3 d = {x * (one + sign * forward.x * forward.x * a) + y * b + forward.x * cosine,
                  x * (sign * b) + y * (sign + forward.y * forward.y * a) + forward.y * cosine,
                  forward.z * cosine - x * (sign * forward.x) - y * forward.y};
    return d * (one / hn::Sqrt(dot(d, d)));
}

}  // namespace woodcock::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
