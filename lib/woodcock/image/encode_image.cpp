// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/encode_image.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>

#include "woodcock/base/error.h"

namespace woodcock::image {

namespace {

OIIO::TypeDesc typeOf(PixelType type) {
    switch (type) {
        case PixelType::UInt8:
            return OIIO::TypeDesc::UINT8;
        case PixelType::UInt16:
            return OIIO::TypeDesc::UINT16;
        case PixelType::Half:
            return OIIO::TypeDesc::HALF;
        case PixelType::Float:
            break;
    }
    return OIIO::TypeDesc::FLOAT;
}

struct AttributeSetter {
    OIIO::ImageSpec& spec;
    const std::string& name;

    void operator()(int v) const { spec.attribute(name, v); }
    void operator()(float v) const { spec.attribute(name, v); }
    void operator()(const std::string& v) const { spec.attribute(name, v); }
    void operator()(const std::vector<float>& v) const {
        spec.attribute(name, OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, static_cast<int>(v.size())),
                       v.data());
    }
    void operator()(Rational v) const {
        const std::array<int, 2> numbers{v.numerator, static_cast<int>(v.denominator)};
        spec.attribute(name, OIIO::TypeRational, numbers.data());
    }
    void operator()(const Matrix44& v) const { spec.attribute(name, OIIO::TypeMatrix44, v.data()); }
};

OIIO::ImageSpec specOf(const ImageHeader& header) {
    OIIO::ImageSpec spec(header.window.width(), header.window.height(),
                         static_cast<int>(header.channels.size()), OIIO::TypeDesc::FLOAT);
    spec.x = header.window.x0, spec.y = header.window.y0;
    spec.full_width = header.width, spec.full_height = header.height;
    spec.channelnames.clear(), spec.channelformats.clear();
    spec.alpha_channel = spec.z_channel = -1;
    for (const ImageChannel& channel : header.channels) {
        const int i = static_cast<int>(spec.channelnames.size());
        if (channel.name == "A") spec.alpha_channel = i;
        if (channel.name == "Z") spec.z_channel = i;
        spec.channelnames.push_back(channel.name);
        spec.channelformats.push_back(typeOf(channel.type));
    }
    // Formats with one type for all channels take it from here.
    spec.format = spec.channelformats.front();
    for (const auto& [name, value] : header.attributes)
        std::visit(AttributeSetter{spec, name}, value);
    return spec;
}

}  // namespace

// Into memory: OpenEXR closes its file in a destructor, which hides a full disk.
std::vector<unsigned char> encodeImage(const ImageHeader& header, std::span<const float> pixels) {
    std::vector<unsigned char> bytes;
    // Reserved at once: growing would hold it twice. No encoder makes pixels that it cannot
    // compress much larger.
    std::size_t pixelBytes = 0;
    for (const ImageChannel& channel : header.channels) pixelBytes += typeOf(channel.type).size();
    bytes.reserve(pixels.size() / std::max<std::size_t>(header.channels.size(), 1) * pixelBytes +
                  (1 << 16));
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const auto output = OIIO::ImageOutput::create(header.format);
    if (!output || !output->supports("ioproxy"))
        throw failure("this build's OpenImageIO cannot encode '{}' images", header.format);
    const bool encoded =
        output->set_ioproxy(&memory) && output->open("memory." + header.format, specOf(header)) &&
        output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) && output->close();
    if (!encoded) throw failure("cannot encode a {} image: {}", header.format, output->geterror());
    return bytes;
}

}  // namespace woodcock::image
