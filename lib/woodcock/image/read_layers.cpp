// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/read_layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "woodcock/base/error.h"
#include "woodcock/base/printable.h"
#include "woodcock/image/film_state.h"
#include "woodcock/image/openimageio_input.h"

namespace woodcock::image {

namespace {

Film::Window windowOf(const OIIO::ImageSpec& spec) {
    const int x = spec.x - spec.full_x, y = spec.y - spec.full_y;
    return {x, y, x + spec.width, y + spec.height};
}

/// The resolution of all channels that are not integers; 0 where all are.
double resolutionOf(const OIIO::ImageSpec& spec) {
    // Renderers sum up to a thousand samples in floats, which costs ten bits.
    constexpr double half = 0x1p-11, single = 0x1p-14;
    double coarsest = 0;
    for (int c = 0; c < spec.nchannels; ++c)
        if (const OIIO::TypeDesc type = spec.channelformat(c); type.is_floating_point())
            coarsest = std::max(coarsest, type == OIIO::TypeDesc::HALF ? half : single);
    return coarsest;
}

/// Half of the step between integers, whose full range is 1.
float halfStep(OIIO::TypeDesc type) {
    return type.is_floating_point()
               ? 0.0f
               : static_cast<float>(0.5 / (std::exp2(8.0 * static_cast<double>(type.size())) - 1));
}

/// Layer and channel of a channel's full name.
ImagePlane planeOf(const std::string& name) {
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos) return {"", name, {}, {}};
    return {name.substr(0, dot), name.substr(dot + 1), {}, {}};
}

std::string prefixOf(const OIIO::ImageSpec& spec, int part) {
    if (part == 0) return {};
    const std::string name = spec.get_string_attribute("oiio:subimagename");
    return (name.empty() ? fmt::format("part{}", part) : name) + ".";
}

void readPart(OpenImage& input, int part, LayeredImage& image) {
    const OIIO::ImageSpec& spec = input.spec();
    const std::size_t channels = static_cast<std::size_t>(spec.nchannels),
                      pixels = static_cast<std::size_t>(spec.image_pixels());
    std::vector<float> all(pixels * channels);
    input.read(all.data());
    const std::string prefix = prefixOf(spec, part);
    for (std::size_t c = 0; c < channels; ++c) {
        ImagePlane plane = planeOf(printable(prefix + spec.channelnames[c]));
        plane.values.resize(pixels);
        for (std::size_t i = 0; i < pixels; ++i) plane.values[i] = all[i * channels + c];
        if (const float half = halfStep(spec.channelformat(static_cast<int>(c))); half > 0)
            plane.roundings.assign(pixels, half);
        image.planes.push_back(std::move(plane));
    }
}

std::map<std::string, std::string> factsOf(const OIIO::ImageSpec& spec) {
    std::map<std::string, std::string> facts;
    for (const OIIO::ParamValue& value : spec.extra_attribs)
        if (value.type().numelements() == 1)
            facts[value.name().string()] = printable(value.get_string());
    return facts;
}

ImagePlane* planeAt(LayeredImage& image, const std::string& name) {
    const auto found = std::find_if(image.planes.begin(), image.planes.end(),
                                    [&](const ImagePlane& plane) { return plane.name() == name; });
    return found == image.planes.end() ? nullptr : &*found;
}

}  // namespace

const ImagePlane* LayeredImage::find(const std::string& name) const {
    for (const ImagePlane& plane : planes)
        if (plane.name() == name) return &plane;
    return nullptr;
}

std::optional<double> LayeredImage::number(const std::string& fact) const {
    const auto found = facts.find(fact);
    if (found == facts.end()) return {};
    char* end = nullptr;
    const double value = std::strtod(found->second.c_str(), &end);
    if (end == found->second.c_str() || *end) return {};
    return value;
}

LayeredImage readLayers(const std::filesystem::path& file) {
    OpenImage input(file);
    const OIIO::ImageSpec first = input.spec();
    LayeredImage image;
    image.file = file;
    image.width = first.full_width, image.height = first.full_height;
    image.window = windowOf(first);
    image.resolution = resolutionOf(first);
    image.straightAlpha = first.get_int_attribute("oiio:UnassociatedAlpha") != 0;
    image.facts = factsOf(first);
    // Only the parts of an EXR belong together; other formats have thumbnails and pages as parts.
    for (int part = 0; part == 0 || (input.isExr() && input.goTo(part)); ++part) {
        const OIIO::ImageSpec& spec = input.spec();
        if (spec.get_string_attribute("oiio:subimagename") == stateName) continue;
        if (spec.full_width != image.width || spec.full_height != image.height ||
            windowOf(spec) != image.window)
            throw input.unreadable(fmt::format(
                "its part {} has another window of pixels than the first, which is not supported",
                part));
        readPart(input, part, image);
    }
    return image;
}

void makeSceneLinear(LayeredImage& image, const std::string& space, const ColorConfig& config) {
    const std::string from = space.empty() && image.resolution == 0 ? config.pictureSpace() : space;
    if (image.resolution == 0 && from.empty())
        throw inputError(
            "the OpenColorIO config has no known colour space for pictures such as '{}'; name the "
            "colour space to read it in",
            image.file.string());
    if (from.empty() && !image.straightAlpha) return;
    for (ImagePlane& red : image.planes) {
        const std::string prefix = red.layer.empty() ? "" : red.layer + ".";
        const bool grey = red.channel == "Y";
        if (!grey && red.channel != "R") continue;
        ImagePlane* const green = grey ? &red : planeAt(image, prefix + "G");
        ImagePlane* const blue = grey ? &red : planeAt(image, prefix + "B");
        const ImagePlane* const alpha = planeAt(image, prefix + "A");
        if (!green || !blue) continue;
        const std::array<ImagePlane*, 3> colour{&red, green, blue};
        const std::size_t pixels = red.values.size();
        // Also of the numbers half a step up, where there are steps.
        std::vector<float> rgb(pixels * 3), above(red.roundings.empty() ? 0 : pixels * 3);
        for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = colour[i % 3]->values[i / 3];
        for (std::size_t i = 0; i < above.size(); ++i)
            above[i] = rgb[i] + colour[i % 3]->roundings[i / 3];
        for (std::vector<float>* colours : {&rgb, &above})
            if (!from.empty() && !colours->empty()) config.toSceneLinear(*colours, from);
        // Grey is one plane, and gets the same number three times.
        for (std::size_t i = 0; i < rgb.size(); ++i) {
            const float a = image.straightAlpha && alpha ? alpha->values[i / 3] : 1.0f;
            colour[i % 3]->values[i / 3] = a * rgb[i];
            if (!above.empty()) colour[i % 3]->roundings[i / 3] = a * std::abs(above[i] - rgb[i]);
        }
    }
    image.straightAlpha = false;
}

}  // namespace woodcock::image
