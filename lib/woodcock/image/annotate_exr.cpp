// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/annotate_exr.h"

#include "woodcock/base/error.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/image/openimageio_input.h"

namespace woodcock {

void annotateExr(const std::filesystem::path& from, const std::filesystem::path& to,
                 const std::vector<std::pair<std::string, ImageAttribute>>& attributes) {
    OpenImage input(from);
    const OIIO::ImageSpec& spec = input.spec();
    std::vector<float> pixels(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
    input.read(pixels.data());

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
