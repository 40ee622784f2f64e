// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/image/film_state.h"
#include "woodcock/render/session.h"

namespace woodcock::render {

/// How parts are to be merged.
struct MergeSettings {
    bool partial = false;      ///< also where samples or pixels are missing
    std::optional<int> spp{};  ///< each seed must reach this number of samples in every pixel
};

/// A picture of several parts.
struct MergedParts {
    image::Film film;
    std::optional<image::MatteFilm> mattes = {};  ///< where the parts have them
    std::optional<image::DeepFilm> deep = {};
    std::vector<std::uint64_t> seeds = {};  ///< in the order of the parts
    /// The samples [firstSample, endSample) of each pixel, of all seeds one after the other: what
    /// every pixel has at least, or, of adaptive parts, as much work.
    int firstSample = 0, endSample = 0;
    bool adaptive = false;
    double seconds = 0;                     ///< of all renders together
    std::vector<std::string> missing = {};  ///< what is, one sentence each; only where `partial`
};

/// Adds the films of parts of one picture: ranges of samples, tiles, other seeds, and all of these
/// together. Each sample counts once, so the result is that of one render, up to the rounding of
/// double sums. Parts of different seeds weigh as much as they have samples in a pixel; the number
/// of an adaptive part's samples does not depend on these, so the mean stays unbiased (see
/// SamplePlan). Points of deep pixels are grouped anew where several parts hold samples of a pixel:
/// see DeepFilm::add().
/// Throws Error{Input} where parts are of different scenes, sizes or layers, or have other bins of
/// deep pixels, where two hold the same sample of a pixel, and, unless `partial`, where some are
/// missing: it names all of them. Samples are missing before a range that begins later and after
/// one that ends early, of a seed that others have; not after a part that a limit of time or noise
/// ended.
MergedParts mergeParts(const std::vector<std::filesystem::path>& files,
                       const MergeSettings& settings);

}  // namespace woodcock::render
