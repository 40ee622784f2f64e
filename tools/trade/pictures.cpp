// SPDX-License-Identifier: Apache-2.0
#include "tools/trade/pictures.h"

#include "woodcock/compare/pack.h"
#include "woodcock/image/display.h"
#include "woodcock/image/encode_image.h"

namespace woodcock::tool {

namespace {

std::vector<unsigned char> png(const trade::Pixels& pixels, trade::PictureSize size,
                               const image::DisplayTransform& transform) {
    std::vector<float> rgba;
    for (std::size_t i = 0; i < pixels.size(); i += 3)
        rgba.insert(rgba.end(), {pixels[i], pixels[i + 1], pixels[i + 2], 1.0f});
    transform.apply(rgba);
    std::vector<float> rgb;
    for (std::size_t i = 0; i < rgba.size(); i += 4)
        rgb.insert(rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
    const image::ImageHeader header{"png",
                                    {0, 0, size.width, size.height},
                                    size.width,
                                    size.height,
                                    {{"R", image::PixelType::UInt8},
                                     {"G", image::PixelType::UInt8},
                                     {"B", image::PixelType::UInt8}},
                                    {}};
    return image::encodeImage(header, rgb);
}

}  // namespace

std::vector<std::string> tradePictures(const trade::TradeResult& result,
                                       const scene::SceneDescription& scene) {
    const scene::OutputDescription& output = scene.output;
    const image::DisplayTransform transform =
        image::ColorConfig(scene.ocio)
            .displayTransform({output.display, output.view, output.look, output.exposure});
    std::vector<std::string> pictures;
    for (const trade::TradeCrop& crop : result.crops)
        pictures.push_back("data:image/png;base64," +
                           compare::base64(png(crop.pixels, result.measured, transform)));
    return pictures;
}

}  // namespace woodcock::tool
