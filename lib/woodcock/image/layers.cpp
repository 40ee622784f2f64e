// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/layers.h"

#include <fmt/format.h>

#include <algorithm>

#include "woodcock/base/error.h"
#include "woodcock/base/nearest_name.h"

namespace woodcock::image {

namespace {

const std::string all = "all", none = "default", allGroups = "lightgroups";

void copy(Rgb from, float* to) { std::copy(from.c.begin(), from.c.end(), to); }
void copy(Vec3f from, float* to) { to[0] = from.x, to[1] = from.y, to[2] = from.z; }

std::vector<std::string> channelsOf(const std::string& layer, std::string_view letters) {
    std::vector<std::string> channels;
    for (const char letter : letters) channels.push_back(layer + "." + letter);
    return channels;
}

/// A layer of three channels, `letters`, that the film holds under a function of its own.
template <class Value>
Layer colour(std::string name, std::string doc, std::string_view letters, bool exact,
             std::function<void(LayerNeeds&)> need, Value (Film::*value)(int, int) const) {
    std::vector<std::string> channels = channelsOf(name, letters);
    return {std::move(name),
            std::move(doc),
            std::move(channels),
            exact,
            std::move(need),
            [value](const Film& film, int x, int y, float* to) { copy((film.*value)(x, y), to); }};
}

Layer number(std::string name, std::string doc, std::string channel,
             std::function<void(LayerNeeds&)> need,
             std::function<float(const Film&, int x, int y)> value) {
    return {std::move(name),
            std::move(doc),
            {std::move(channel)},
            true,
            std::move(need),
            [value = std::move(value)](const Film& film, int x, int y, float* to) {
                *to = value(film, x, y);
            }};
}

Layer light(LightKind kind, std::string doc) {
    const std::string& name = lightKindNames[static_cast<std::size_t>(kind)];
    return {
        name,
        std::move(doc),
        channelsOf(name, "RGB"),
        false,
        [](LayerNeeds& needs) { needs.parts.kinds = true; },
        [kind](const Film& film, int x, int y, float* to) { copy(film.light(kind, x, y), to); }};
}

Layer noise(std::string name, std::string doc, Rgb (Film::*value)(int, int) const) {
    Layer layer = colour(
        std::move(name), std::move(doc), "RGB", true, [](LayerNeeds&) {}, value);
    layer.ofNoise = true;
    return layer;
}

Layer motion() {
    return {"motion",
            "by how many pixels what the camera rays meet first moves, right and down, until the "
            "next frame",
            channelsOf("motion", "XY"),
            true,
            [](LayerNeeds& needs) { needs.places = true; },
            [](const Film& film, int x, int y, float* to) {
                std::tie(to[0], to[1]) = std::make_pair(film.motion(x, y)[0], film.motion(x, y)[1]);
            }};
}

std::vector<Layer> makeTable() {
    const auto nothing = [](LayerNeeds&) {};
    const auto depth = [](LayerNeeds& needs) { needs.depth = true; };
    const auto features = [](LayerNeeds& needs) { needs.features = true; };
    const auto places = [](LayerNeeds& needs) { needs.places = true; };
    const auto stops = [](LayerNeeds& needs) { needs.stops = true; };
    return {
        number("depth",
               "mean distance to what camera rays meet, weighted by the light that gets there; "
               "1e10 where they meet nothing",
               "Z", depth, &Film::depth),
        number("depth_first", "mean distance at which camera rays have lost 1 % of their light",
               "depth_first.Z", stops, &Film::firstDepth),
        number("depth_half", "mean distance at which camera rays have lost half of their light",
               "depth_half.Z", stops, &Film::halfDepth),
        colour("albedo", "mean albedo of what camera rays meet first", "RGB", false, features,
               &Film::albedo),
        colour("normal", "mean normal of what camera rays meet first, in world space", "XYZ", false,
               features, &Film::normal),
        colour("position", "mean place of what camera rays meet first, in world space", "XYZ", true,
               places, &Film::position),
        motion(),
        light(LightKind::VolumeDirect, "light that was scattered once, in a medium"),
        light(LightKind::VolumeIndirect,
              "light that was scattered more than once, and last, on its way to the camera, in a "
              "medium"),
        light(LightKind::Emission,
              "light straight from what glows: media, surfaces, and lamps in sight"),
        light(LightKind::SurfaceDirect, "light that one surface reflected or refracted"),
        light(LightKind::SurfaceIndirect,
              "light that was scattered more than once, and last by a surface"),
        light(LightKind::Background, "light straight from environments and suns"),
        colour("transmittance", "share of the light from behind that comes through", "RGB", false,
               depth, &Film::transmittance),
        number("samples", "number of samples of the pixel", "samples", nothing,
               [](const Film& film, int x, int y) {
                   return static_cast<float>(film.at(x, y).samples);
               }),
        noise("error", "standard error of R, G and B; not of denoised pictures",
              &Film::standardError),
        noise("variance", "the square of that", &Film::variance),
    };
}

Layer groupLayer(const std::string& name, LightGroup number) {
    return {groupPrefix + name,
            "light of a group",
            channelsOf(groupPrefix + name, "RGB"),
            false,
            [](LayerNeeds&) {},
            [number](const Film& film, int x, int y, float* to) {
                copy(film.lightOfGroup(number, x, y), to);
            }};
}

bool isGroup(const std::string& layer) {
    return layer == allGroups || layer.starts_with(groupPrefix);
}

const Layer* findLayer(const std::string& name) {
    for (const Layer& layer : layerTable())
        if (layer.name == name) return &layer;
    return nullptr;
}

/// Which layers a list names, and how.
class Request {
public:
    Request(const std::vector<std::string>& names, bool half)
        : names_(parseLayerNames(names)), half_(half) {}

    bool asksForGroups() const {
        return std::any_of(names_.begin(), names_.end(),
                           [](const LayerName& name) { return isGroup(name.layer); });
    }
    /// Adds the layer where it is asked for, by its own name or by one that stands for it.
    void choose(const Layer& layer, std::initializer_list<std::string> collective,
                LayerList& list) const {
        const LayerName* asked = find(layer.name);
        for (const std::string& name : collective)
            if (!asked) asked = find(name);
        if (!asked) return;
        using enum LayerName::Precision;
        const bool half = asked->precision == Half || (asked->precision == Any && half_);
        list.push_back({layer, half && !layer.exact});
    }
    /// Throws where a group is named that is not among these layers.
    void requireGroups(const LayerList& list, const std::vector<std::string>& known) const {
        for (const LayerName& name : names_) {
            if (!name.layer.starts_with(groupPrefix)) continue;
            const auto has = [&](const ChosenLayer& l) { return l.layer.name == name.layer; };
            if (!std::any_of(list.begin(), list.end(), has))
                throw usageError("the scene has no light group for the layer '{}'{}", name.layer,
                                 suggestName(name.layer, "its layers of groups", known));
        }
    }

private:
    const LayerName* find(const std::string& layer) const {
        for (const LayerName& name : names_)
            if (name.layer == layer) return &name;
        return nullptr;
    }
    std::vector<LayerName> names_;
    bool half_;
};

}  // namespace

std::string Layer::nameInPart(const std::string& channel) const {
    const std::string prefix = name + ".";
    return channel.starts_with(prefix) ? channel.substr(prefix.size()) : channel;
}

std::span<const Layer> layerTable() {
    static const std::vector<Layer> table = makeTable();
    return table;
}

std::vector<std::string> layerNames() {
    std::vector<std::string> names;
    for (const Layer& layer : layerTable()) names.push_back(layer.name);
    names.insert(names.end(), {allGroups, all, none});
    return names;
}

LayerName parseLayerName(const std::string& text) {
    const std::size_t colon = text.find(':');
    LayerName name{text.substr(0, colon)};
    const std::vector<std::string> known = layerNames();
    if (!isGroup(name.layer) && std::find(known.begin(), known.end(), name.layer) == known.end())
        throw usageError("unknown layer '{}'{}", name.layer,
                         suggestName(name.layer, "known layers", known));
    if (colon == std::string::npos) return name;
    const std::string precision = text.substr(colon + 1);
    if (precision != "half" && precision != "float")
        throw usageError(
            "'{}' is no precision of the layer '{}'; a layer is half or float, as in {}:half",
            precision, name.layer, name.layer);
    if (name.layer == none)
        throw usageError("'{}' is no layer that could be {}: it stands for none", name.layer,
                         precision);
    name.precision = precision == "half" ? LayerName::Precision::Half : LayerName::Precision::Float;
    if (const Layer* layer = findLayer(name.layer);
        layer && layer->exact && name.precision == LayerName::Precision::Half)
        throw usageError("the layer '{}' is float always: half precision would harm it",
                         name.layer);
    return name;
}

std::vector<LayerName> parseLayerNames(const std::vector<std::string>& texts) {
    std::vector<LayerName> names;
    for (const std::string& text : texts) {
        LayerName name = parseLayerName(text);
        for (const LayerName& other : names) {
            if (other.layer == name.layer)
                throw usageError("the layer '{}' is named twice", name.layer);
            if (other.layer == none || name.layer == none)
                throw usageError("'{}' stands for no layers, and '{}' is one; give one of them",
                                 none, other.layer == none ? name.layer : other.layer);
        }
        names.push_back(std::move(name));
    }
    return names;
}

LayerList layersFromNames(const std::vector<std::string>& names,
                          const std::vector<std::string>& groups, bool half) {
    const Request request(names, half);
    LayerList list;
    for (const Layer& layer : layerTable()) request.choose(layer, {all}, list);
    if (groups.empty() && request.asksForGroups())
        throw usageError(
            "the scene has no light groups: no light, volume or emissive material says group = "
            "\"key\"");
    if (groups.empty()) return list;
    std::vector<std::string> known;
    for (std::size_t i = 0; i <= groups.size(); ++i) {
        const Layer layer =
            groupLayer(i == 0 ? restOfGroups : groups[i - 1], static_cast<LightGroup>(i));
        known.push_back(layer.name);
        request.choose(layer, {allGroups, all}, list);
    }
    request.requireGroups(list, known);
    return list;
}

std::vector<std::string> dropLayersOfNoise(LayerList& layers) {
    std::vector<std::string> dropped;
    for (const ChosenLayer& chosen : layers)
        if (chosen.layer.ofNoise) dropped.push_back(chosen.layer.name);
    std::erase_if(layers, [](const ChosenLayer& chosen) { return chosen.layer.ofNoise; });
    return dropped;
}

LayerNeeds needsOf(const LayerList& layers, const std::vector<std::string>& groups) {
    LayerNeeds needs;
    for (const ChosenLayer& chosen : layers) {
        chosen.layer.need(needs);
        if (isGroup(chosen.layer.name)) needs.parts.groups = groups;
    }
    return needs;
}

}  // namespace woodcock::image
