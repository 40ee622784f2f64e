// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "woodcock/compare/load_pictures.h"
#include "woodcock/compare/metrics.h"
#include "woodcock/compare/tile_test.h"

namespace woodcock::compare {

struct CompareSettings {
    bool resample = false;
    int tile = 8;  ///< least side of a tile, in pixels
    double falseAlarms =
        1e-3;  ///< probability that equal images are found to differ, over all tests
};

/// One channel of an image against the reference's.
struct ChannelComparison {
    std::string name;
    DifferenceMetrics metrics;
    MeanDifference bias;       ///< mean of image - reference
    double ratio = 0;          ///< of the means; NaN where the reference's is 0
    double ratioError = 0;     ///< its standard error
    double chance = 1;         ///< probability of such a bias under equal expectations
    bool tested = true;        ///< false: depth, whose expectation depends on the samples
    bool errorsKnown = false;  ///< false: from the scatter inside tiles
    bool biased = false;       ///< `chance` is too small, over all tests
};

/// A tile whose difference is significant.
struct TileDifference {
    std::size_t channel = 0;  ///< into ImageComparison::channels
    std::size_t tile = 0;     ///< of the grid, row by row
    Tiles::Tile place{};      ///< pixels of what is compared
    MeanDifference difference;
    double chance = 0;
};

/// The FLIP error of R, G, B.
struct FlipComparison {
    double ldr = 0, hdr = 0;  ///< means over pixels
    std::vector<float> hdrMap;
};

struct ImageComparison {
    std::size_t image = 0;  ///< into Comparison::pictures
    std::vector<ChannelComparison> channels;
    std::optional<FlipComparison> flip;
    std::size_t tests = 0;              ///< tiles and whole images, over all channels
    std::vector<TileDifference> tiles;  ///< those that differ, the least chance first
    std::size_t differentTiles = 0;     ///< a tile that differs in several channels counts once
    bool differ = false;
    std::string reason;  ///< why it differs
};

struct Comparison {
    CompareSettings settings;
    std::vector<Picture> pictures;        ///< the first is the reference
    std::vector<ImageComparison> images;  ///< each of the others against it
    std::vector<std::string> notes;
    std::size_t tiles = 0;
};

/// Throws Error{Input} where no pixel of a channel is finite in both.
Comparison compare(LoadedPictures loaded, const CompareSettings& settings);

}  // namespace woodcock::compare
