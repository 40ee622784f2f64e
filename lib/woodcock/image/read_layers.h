// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/image/display.h"
#include "woodcock/image/film.h"

namespace woodcock::image {

/// One channel: "transmittance.R" is channel R of layer transmittance; R, G, B alone are those of
/// the layer without a name.
struct ImagePlane {
    std::string layer, channel;
    std::vector<float> values;  ///< of the image's window, row by row from the top left
    /// How far a value may be from what was rounded to an integer; empty for floats.
    std::vector<float> roundings{};

    std::string name() const { return layer.empty() ? channel : layer + "." + channel; }
};

/// All channels of an image file, as numbers.
struct LayeredImage {
    std::filesystem::path file;
    int width = 0, height = 0;  ///< of the whole image (EXR's display window)
    Film::Window window;        ///< the position of the pixels, from the whole image's top left
    std::vector<ImagePlane> planes;
    /// The relative resolution of the file's numbers; 0: all are integers.
    double resolution = 0;
    bool straightAlpha = false;                ///< colour is not multiplied by alpha
    std::map<std::string, std::string> facts;  ///< numbers and texts of the header, as text

    /// The plane of this name; null: there is none.
    const ImagePlane* find(const std::string& name) const;
    /// A number of the header, such as "woodcock/samples".
    std::optional<double> number(const std::string& fact) const;
};

/// Reads every channel of every part, in any format that OpenImage reads. Integers are scaled to
/// 0..1; NaN and infinite values stay. Channels of a part beyond the first have its name in front.
/// A part that only keeps sums (film_state.h) is left out.
/// Throws Error{Input} where the file cannot be read, holds deep or volumetric pixels or parts of
/// different windows, or does not fit into memory.
LayeredImage readLayers(const std::filesystem::path& file);

/// Makes colour scene-linear and multiplied by alpha, in each layer that has R, G and B. `space` is
/// one of the config's; empty: floats are scene-linear already, integers are sRGB pictures. Throws
/// Error{Input} on a name that the config does not have.
void makeSceneLinear(LayeredImage& image, const std::string& space, const ColorConfig& config);

}  // namespace woodcock::image
