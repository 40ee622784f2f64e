// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/annotate_exr.h"

#include <OpenImageIO/imageio.h>

#include "woodcock/base/error.h"
#include "woodcock/base/whole_file.h"

namespace woodcock {

void annotateExr(const std::filesystem::path& from, const std::filesystem::path& to,
                 const std::vector<std::pair<std::string, ImageAttribute>>& attributes) {
    const auto input = OIIO::ImageInput::open(from.string());
    if (!input) throw inputError("cannot read image '{}': {}", from.string(), OIIO::geterror());
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.deep || spec.depth > 1)
        throw inputError("cannot read image '{}': it has no flat pixels", from.string());
    std::vector<float> pixels(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.data()))
        throw inputError("cannot read image '{}': {}", from.string(), input->geterror());

    ImageHeader header{"openexr",
                       {spec.x, spec.y, spec.x + spec.width, spec.y + spec.height},
                       spec.full_width,
                       spec.full_height,
                       {},
                       {{"compression", "zip"}}};
    for (const std::string& name : spec.channelnames) header.channels.push_back({name});
    header.attributes.insert(header.attributes.end(), attributes.begin(), attributes.end());
    writeWholeFile(to, encodeImage(header, pixels));
}

}  // namespace woodcock
