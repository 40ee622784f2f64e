// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "woodcock/image/denoised_picture.h"
#include "woodcock/image/display.h"
#include "woodcock/image/film.h"

namespace woodcock::image {

struct DisplayFileSettings {
    /// The picture keeps alpha, where its format has one; otherwise it is opaque, on black.
    bool withAlpha = false;
    /// There may be emission that covers nothing: alpha is raised, see below.
    bool glows = false;
    double exposure = 0;  ///< stops that the transform applies
};

/// Writes the film's crop, or what a denoiser made of it, as a picture, by the extension: PNG, JPEG
/// and WebP of 8 bits, TIFF of 16.
/// Alpha is straight, as these formats want it. They cannot add light to the background, so a fire
/// of alpha 0 would be invisible. With `glows`, alpha is at least the brightest channel after
/// exposure, up to 1: the least alpha with which the light is not clipped. Returns the share of
/// pixels whose alpha was raised. Whole or not at all; throws Error{Failure}.
double writeDisplay(const std::filesystem::path& file, const Film& film,
                    const DisplayTransform& transform, const DisplayFileSettings& settings = {},
                    const DenoisedPicture* denoised = nullptr);

}  // namespace woodcock::image
