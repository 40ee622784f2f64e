// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/sample_sequence.h"

namespace woodcock {

namespace {

constexpr std::uint32_t reverseBits(std::uint32_t v) {
    v = (v >> 16) | (v << 16);
    v = ((v & 0x00ff00ffu) << 8) | ((v & 0xff00ff00u) >> 8);
    v = ((v & 0x0f0f0f0fu) << 4) | ((v & 0xf0f0f0f0u) >> 4);
    v = ((v & 0x33333333u) << 2) | ((v & 0xccccccccu) >> 2);
    return ((v & 0x55555555u) << 1) | ((v & 0xaaaaaaaau) >> 1);
}

/// A bijection in which every bit depends on itself and on lower bits only (Laine and Karras 2011,
/// constants of Vegdahl 2021): of reversed bits, a nested uniform (Owen) scramble.
constexpr std::uint32_t scrambleReversed(std::uint32_t v, std::uint32_t seed) {
    v ^= v * 0x3d20adeau;
    v += seed;
    v *= (seed >> 16) | 1;
    v ^= v * 0x05526c56u;
    v ^= v * 0x53a22864u;
    return v;
}

using Matrix = std::array<std::uint32_t, 32>;

/// Direction numbers of a primitive polynomial x^s + a_1 x^(s-1) + ... + 1 (inner coefficients in
/// the bits of `a`) and initial m_1..m_s; Joe and Kuo 2008, "new-joe-kuo-6", dimensions 2 to 4.
template <std::size_t S>
constexpr Matrix sobolMatrix(std::uint32_t a, std::array<std::uint32_t, S> m) {
    Matrix v{};
    for (std::size_t i = 0; i < 32; ++i) {
        if (i < S) {
            v[i] = m[i] << (31 - i);
            continue;
        }
        v[i] = v[i - S] ^ (v[i - S] >> S);
        for (std::size_t k = 1; k < S; ++k)
            if (a >> (S - 1 - k) & 1) v[i] ^= v[i - k];
    }
    return v;
}
constexpr Matrix vanDerCorput() {
    Matrix v{};
    for (std::size_t i = 0; i < 32; ++i) v[i] = 1u << (31 - i);
    return v;
}
constexpr std::array<Matrix, 4> sobol{vanDerCorput(), sobolMatrix<1>(0, {1}),
                                      sobolMatrix<2>(1, {1, 3}), sobolMatrix<3>(1, {1, 3, 1})};

/// The points' digits by the bytes of the index: four look-ups instead of a loop over its bits. The
/// bits of both are reversed, as the scrambles before and after take and leave them.
using Digits = std::array<std::uint32_t, 4>;
constexpr std::array<std::array<Digits, 256>, 4> reversedSobolBytes = [] {
    std::array<std::array<Digits, 256>, 4> table{};
    for (std::size_t byte = 0; byte < 4; ++byte)
        for (std::size_t value = 0; value < 256; ++value)
            for (std::size_t bit = 0; bit < 8; ++bit)
                if (value >> bit & 1)
                    for (std::size_t d = 0; d < 4; ++d)
                        table[byte][value][d] ^= reverseBits(sobol[d][31 - (8 * byte + bit)]);
    return table;
}();

}  // namespace

SampleSequence::SampleSequence(std::uint64_t seed, int x, int y, std::uint32_t sample)
    : pixelSeed_(hashOf(seed, x, y)), reversedIndex_(reverseBits(sample)) {}

SampleSequence SampleSequence::copy(std::uint32_t number, std::uint32_t copies) const {
    SampleSequence sequence = *this;
    sequence.reversedIndex_ = reverseBits(reverseBits(reversedIndex_) * copies + number);
    return sequence;
}

std::array<double, 4> SampleSequence::draw(std::uint32_t set) const {
    const std::uint64_t seed = hashOf(pixelSeed_, set, 0x51);
    const std::uint32_t index = scrambleReversed(reversedIndex_, static_cast<std::uint32_t>(seed));
    Digits bits{};
    for (std::size_t byte = 0; byte < 4; ++byte)
        for (std::size_t d = 0; d < 4; ++d)
            bits[d] ^= reversedSobolBytes[byte][index >> (8 * byte) & 255][d];
    std::array<double, 4> numbers;
    for (std::size_t d = 0; d < 4; ++d) {
        const auto dimensionSeed = static_cast<std::uint32_t>(hashOf(seed, d));
        numbers[d] = reverseBits(scrambleReversed(bits[d], dimensionSeed)) * 0x1p-32;
    }
    return numbers;
}

}  // namespace woodcock
