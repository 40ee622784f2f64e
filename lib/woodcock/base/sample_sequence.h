// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "woodcock/base/random.h"

namespace woodcock {

/// Numbers in [0, 1) for the first dimensions of the path of one sample of one pixel:
/// Owen-scrambled Sobol points in sets of four dimensions, padded with shuffled indices (Burley
/// 2020, "Practical Hash-based Owen Scrambling"). Every pixel has a sequence of its own, and its
/// sample i is the i-th point. So any range of samples can be rendered by itself; only powers of
/// two are favoured as numbers of samples. Depends on (seed, pixel, sample) only.
class SampleSequence {
public:
    SampleSequence(std::uint64_t seed, int x, int y, std::uint32_t sample);

    /// The sequence of one of `copies` copies of the sample. Those of all samples of a pixel are
    /// one sequence, so many times as long.
    SampleSequence copy(std::uint32_t number, std::uint32_t copies) const;

    /// Four numbers of dimensions 4 set ... 4 set + 3.
    std::array<double, 4> draw(std::uint32_t set) const;

private:
    std::uint64_t pixelSeed_;
    std::uint32_t reversedIndex_;  ///< of the sample, by bits
};

}  // namespace woodcock
