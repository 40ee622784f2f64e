// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/image/display.h"
#include "woodcock/image/film.h"
#include "woodcock/image/write_exr.h"

namespace woodcock {

struct OutputSettings {
    std::vector<std::filesystem::path> files = {};  ///< each in the format of its extension
    bool half = false;                              ///< EXR colour in half instead of float
    ExrLayers layers = {};                          ///< of the EXR files
    DisplaySettings display = {};                   ///< of all others, which are pictures
    ColorConfig colour;                             ///< for them, and for the EXR's chromaticities
    bool withAlpha = false;  ///< pictures keep alpha: for renders whose environment is not visible
    bool glows = false;      ///< there is light where nothing covers; see writeDisplay()
};

/// The files that one render writes. Made before it, so that what would fail at its end (an
/// unknown extension or view, a missing directory) fails at once.
class Outputs {
public:
    /// Throws Error{Usage} or Error{Input}.
    explicit Outputs(OutputSettings settings);

    /// What the user should know about the colour configuration; empty: nothing.
    const std::string& note() const { return settings_.colour.note(); }

    /// Bytes of memory for each pixel that write() takes beside the film.
    double bytesPerPixel() const;

    /// Writes every file, the others too when one fails; then throws Error{Failure} of those.
    /// Returns what the user should know of what was written; empty: nothing.
    std::string write(const Film& film, const RenderMetadata& metadata) const;

private:
    OutputSettings settings_;
    std::optional<DisplayTransform> transform_;  ///< where a file needs it
};

}  // namespace woodcock
