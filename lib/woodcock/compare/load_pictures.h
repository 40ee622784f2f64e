// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "woodcock/compare/picture.h"
#include "woodcock/image/display.h"

namespace woodcock {

/// What to compare: one image.
struct PictureSource {
    std::filesystem::path file;
    std::vector<std::filesystem::path> more;  ///< the same with other seeds
    std::string colourSpace;                  ///< empty: as makeSceneLinear() has it
};

struct LoadedPictures {
    std::vector<Picture> pictures;   ///< of one size, with the same planes in the same order
    std::vector<std::string> notes;  ///< what the user should know: crops, resampling, seeds
};

/// Reads the images, lettered A, B, C ..., makes them scene-linear, and lays them over each other:
/// of different data windows, what all have. Layers `error` and `samples` are no planes of their
/// own; the first becomes the standard errors. Images of other sizes are refused, or with
/// `resample` all are averaged over areas down to the smallest width and height. Throws
/// Error{Input} or Error{Usage}.
LoadedPictures loadPictures(const std::vector<PictureSource>& sources, bool resample,
                            const ColorConfig& config);

}  // namespace woodcock
