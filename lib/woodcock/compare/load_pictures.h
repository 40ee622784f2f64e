// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "woodcock/compare/picture.h"
#include "woodcock/image/display.h"

namespace woodcock::compare {

/// What to compare: one image.
struct PictureSource {
    std::filesystem::path file;
    std::vector<std::filesystem::path> more;  ///< the same picture with other seeds
    std::string colourSpace;                  ///< empty: as makeSceneLinear() has it
};

struct LoadedPictures {
    std::vector<Picture> pictures;   ///< of one size, with the same planes in the same order
    std::vector<std::string> notes;  ///< for the user: crops, resampling, seeds
};

/// Reads the images, lettered A, B, C ..., makes them scene-linear, and keeps the common part of
/// their data windows. Layers `error` and `samples` are not compared; `error` gives the standard
/// errors. Images of different sizes are refused; with `resample`, all are averaged over areas down
/// to the smallest width and height. Throws Error{Input} or Error{Usage}.
LoadedPictures loadPictures(const std::vector<PictureSource>& sources, bool resample,
                            const image::ColorConfig& config);

}  // namespace woodcock::compare
