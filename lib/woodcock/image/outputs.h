// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/image/display.h"
#include "woodcock/image/film.h"
#include "woodcock/image/write_exr.h"

namespace woodcock::image {

struct OutputSettings {
    std::vector<std::filesystem::path> files = {};  ///< each in the format of its extension
    std::filesystem::path matteFile = {};           ///< of mattes alone; empty: they go to the EXRs
    std::filesystem::path deepFile = {};            ///< empty: none
    std::size_t matteLayers = 0;                    ///< how many the EXR files get
    bool half = false;                              ///< EXR colour in half instead of float
    LayerList layers = {};                          ///< of the EXR files
    bool multipart = false;                         ///< their layers are parts of their own
    bool denoised = false;                          ///< write() gets a denoised picture
    DisplaySettings display = {};                   ///< of all others, which are pictures
    ColorConfig colour;                             ///< for those, and for the EXR's chromaticities
    bool withAlpha = false;  ///< pictures keep alpha; for renders whose environment is not visible
    bool glows = false;      ///< there is emission that covers nothing; see writeDisplay()
};

/// The files that a render writes. Make it before rendering, so that errors (an unknown extension
/// or view, a missing directory) appear at once.
class Outputs {
public:
    /// Throws Error{Usage} or Error{Input}.
    explicit Outputs(OutputSettings settings);

    /// A note about the colour configuration for the user; may be empty.
    const std::string& note() const { return settings_.colour.note(); }

    /// Bytes of memory for each pixel that write() takes beside the film.
    double bytesPerPixel() const;

    /// Writes every file. If some fail, it writes the others and then throws Error{Failure} that
    /// names those. Returns a note for the user; may be empty. With `state`, EXR files keep that.
    std::string write(const Film& film, const RenderMetadata& metadata,
                      const BesideFilm& beside = {}, const FilmState* state = nullptr) const;

    /// Writes an EXR of the same kind, of the film as it is. Throws Error{Failure}.
    void writeCheckpoint(const std::filesystem::path& file, const Film& film,
                         const RenderMetadata& metadata, const FilmState& state,
                         const MatteFilm* mattes = nullptr) const {
        writeExr(file, film, metadata, exrSettings(), &state, ofExr({.mattes = mattes}));
    }

private:
    ExrSettings exrSettings() const;
    /// Without what has a file of its own.
    BesideFilm ofExr(BesideFilm beside) const {
        if (!settings_.matteFile.empty()) beside.mattes = nullptr;
        return beside;
    }
    double write(const std::filesystem::path& file, const Film& film,
                 const RenderMetadata& metadata, const BesideFilm& beside,
                 const FilmState* state) const;

    OutputSettings settings_;
    std::optional<DisplayTransform> transform_;  ///< where a file needs it
};

}  // namespace woodcock::image
