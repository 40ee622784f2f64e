// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/support/read_back.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace woodcock::proof {

bool ReadBack::has(const std::string& channel) const { return types.count(channel) == 1; }

float ReadBack::at(int px, int py, const std::string& channel) const {
    const auto found = std::find(channels.begin(), channels.end(), channel);
    if (found == channels.end() || px < x || py < y || px >= x + width || py >= y + height)
        throw std::out_of_range("no " + channel + " there");
    const auto pixel =
        static_cast<size_t>(py - y) * static_cast<size_t>(width) + static_cast<size_t>(px - x);
    return values[pixel * channels.size() + static_cast<size_t>(found - channels.begin())];
}

ReadBack readBack(const std::filesystem::path& file, int part) {
    OIIO::ImageSpec asIs;
    asIs["oiio:UnassociatedAlpha"] = 1;
    const auto input = OIIO::ImageInput::open(file.string(), &asIs);
    if (!input) throw std::runtime_error(OIIO::geterror());
    if (part > 0 && !input->seek_subimage(part, 0))
        throw std::out_of_range("no part " + std::to_string(part) + " in " + file.string());
    const OIIO::ImageSpec& spec = input->spec();
    ReadBack image{spec.x,
                   spec.y,
                   spec.width,
                   spec.height,
                   spec.full_width,
                   spec.full_height,
                   spec.channelnames,
                   {},
                   {},
                   {}};
    for (int c = 0; c < spec.nchannels; ++c)
        image.types[spec.channel_name(c)] = spec.channelformat(c).c_str();
    for (const auto& attribute : spec.extra_attribs)
        image.attributes[attribute.name().string()] = attribute.get_string();
    image.values.resize(static_cast<size_t>(spec.image_pixels()) *
                        static_cast<size_t>(spec.nchannels));
    if (!input->read_image(part, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.values.data()))
        throw std::runtime_error(input->geterror());
    if (spec.format == OIIO::TypeDesc::UINT8)
        for (float& v : image.values) v = std::round(v * 255);
    return image;
}

void writeFloats(const std::filesystem::path& file, int width, int height, int channels,
                 const std::vector<float>& values) {
    const auto output = OIIO::ImageOutput::create(file.string());
    const OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::FLOAT);
    if (!output || !output->open(file.string(), spec) ||
        !output->write_image(OIIO::TypeDesc::FLOAT, values.data()) || !output->close())
        throw std::runtime_error("cannot write " + file.string());
}

}  // namespace woodcock::proof
