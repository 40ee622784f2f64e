// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "woodcock/image/film.h"

namespace woodcock::render {

/// The samples that a part of a picture holds.
struct PartCoverage {
    std::string name;  ///< for messages
    image::Film::Window window;
    std::uint64_t seed = 0;
    std::uint32_t first = 0;
    std::uint32_t end = 0;                  ///< of every pixel, where `drawn` is empty
    std::vector<std::uint32_t> drawn = {};  ///< the end by pixel, row by row
    /// The end that it was to reach; 0: wherever it ended.
    std::uint32_t asked = 0;
};

/// What is wrong with the parts of a picture, one sentence each.
struct CoverageFaults {
    std::vector<std::string> doubled, missing;
};

/// Looks at every pixel of `picture` for every seed: whether two parts hold the same sample, and
/// whether samples are missing up to the end that a part was to reach, or to `spp`.
CoverageFaults findFaults(const std::vector<PartCoverage>& parts, image::Film::Window picture,
                          std::uint32_t spp);

}  // namespace woodcock::render
