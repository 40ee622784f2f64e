// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "woodcock/image/chromaticities.h"
#include "woodcock/image/deep_film.h"
#include "woodcock/image/denoised_picture.h"
#include "woodcock/image/encode_image.h"
#include "woodcock/image/film.h"
#include "woodcock/image/film_state.h"
#include "woodcock/image/layers.h"
#include "woodcock/image/matte_film.h"

namespace woodcock::image {

/// How an image was rendered, for its header.
struct RenderMetadata {
    int firstSample = 0, endSample = 0;
    std::uint64_t seed = 0;
    double renderSeconds = 0;
    std::string sceneDigest;
    std::string commandLine;  ///< empty: not written
    bool adaptive = false;    ///< as much work as the sample range in every pixel
    /// Of the camera, as OpenEXR's standard attributes of these names have it; absent: not written.
    std::optional<Matrix44> worldToCamera = {}, worldToNdc = {};
    /// Frames in a second; absent: not known. A shutter is open for a part of a frame.
    std::optional<Rational> framesPerSecond = {};
    double shutter = 0;
};

/// What may belong to a film, of the same samples; null: nothing.
struct BesideFilm {
    const MatteFilm* mattes = nullptr;
    const DeepFilm* deep = nullptr;
    const DenoisedPicture* denoised = nullptr;  ///< in place of the film's radiance
};

struct ExrSettings {
    bool half = false;  ///< R, G, B, A in half, clamped to its largest number; else float
    LayerList layers = {};
    std::optional<Chromaticities> chromaticities = {};  ///< of the working space, where it is known
    std::string interopId = {};  ///< its name by the Color Interop Forum; empty: not known
    /// Each layer in a part of its own, after the part "rgba" with R, G, B and A; else all channels
    /// in one part.
    bool multipart = false;
    bool denoised = false;  ///< R, G, B are of a DenoisedPicture, and the film's own are a layer
};

/// Bytes of a pixel that writeExr() takes while it works: as floats, and as the file holds it.
double exrBytesPerPixel(const ExrSettings& settings);

/// Writes the film's means, premultiplied by alpha, with the crop as data window; with `state`,
/// also that; with mattes, their layers of Cryptomatte; with a denoised picture, that as R, G and
/// B, and the film's own as the layer `noisy`. Whole or not at all; throws Error{Failure}.
void writeExr(const std::filesystem::path& file, const Film& film, const RenderMetadata& metadata,
              const ExrSettings& settings, const FilmState* state = nullptr,
              const BesideFilm& beside = {});

/// The layer of a denoised picture's file that holds the picture as it was rendered.
inline constexpr const char* noisyLayer = "noisy";

/// Writes the image `from`, of flat pixels in any format that is read, as an EXR of floats. It has
/// the same channels, and these attributes in place of its own. Whole or not at all. Throws
/// Error{Input} where `from` cannot be read, Error{Failure} where `to` cannot be written.
void annotateExr(const std::filesystem::path& from, const std::filesystem::path& to,
                 const std::vector<std::pair<std::string, ImageAttribute>>& attributes);

}  // namespace woodcock::image
