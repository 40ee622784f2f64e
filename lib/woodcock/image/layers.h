// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "woodcock/image/film.h"

namespace woodcock::image {

// The layers that an EXR may hold beside R, G, B and A. They are written once, in the table of
// layers.cpp. Options, the scene's key, what is sampled, the file and the guide follow from it.

struct Layer {
    std::string name;  ///< as users write it
    std::string doc;   ///< what it holds, for help and the guide
    /// As in a file of one part: "albedo.R". In a part of its own, without the layer's name.
    std::vector<std::string> channels;
    /// Half precision would harm it: places, distances, counts, variances.
    bool exact = false;
    std::function<void(LayerNeeds&)> need;                           ///< adds what it needs
    std::function<void(const Film&, int x, int y, float* to)> fill;  ///< its channels of a pixel
    bool ofNoise = false;  ///< it describes the noise of R, G and B, so not of a denoised picture

    std::string nameInPart(const std::string& channel) const;
};

/// All layers but those of light groups, in the order in which files hold them.
std::span<const Layer> layerTable();

/// The names that users write: those of the table; "lightgroups", which stands for all of them;
/// "all" and "default".
std::vector<std::string> layerNames();

/// The name of a layer as users write it, with the precision that they may add to it: "emission",
/// "emission:half", "emission:float".
struct LayerName {
    std::string layer;
    enum class Precision { Any, Half, Float } precision = Precision::Any;
};
/// Throws Error{Usage} on another precision, on half precision of what is exact, and on a layer
/// that is not known. Of a light group only the prefix is checked.
LayerName parseLayerName(const std::string& text);
/// The same for a list. Also throws where a layer is named twice, or beside "default".
std::vector<LayerName> parseLayerNames(const std::vector<std::string>& texts);

struct ChosenLayer {
    Layer layer;
    bool half = false;
};
using LayerList = std::vector<ChosenLayer>;

/// The layers of these names, in the order of the table, then those of light groups. `groups`: all
/// of the scene, without the rest. `half`: the precision of those that say nothing and are not
/// exact. Throws Error{Usage} as above, and on groups that the scene does not have.
LayerList layersFromNames(const std::vector<std::string>& names,
                          const std::vector<std::string>& groups = {}, bool half = false);

/// Takes out the layers that say nothing of a denoised picture, and returns their names.
std::vector<std::string> dropLayersOfNoise(LayerList& layers);

/// What these layers need; `groups` as above.
LayerNeeds needsOf(const LayerList& layers, const std::vector<std::string>& groups = {});

}  // namespace woodcock::image
