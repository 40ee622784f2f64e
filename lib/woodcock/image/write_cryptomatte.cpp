// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/write_cryptomatte.h"

#include <fmt/format.h>

#include "woodcock/base/version.h"
#include "woodcock/base/whole_file.h"

namespace woodcock::image {

void writeCryptomatte(const std::filesystem::path& file, const MatteFilm& mattes, const Film& film,
                      const RenderMetadata& metadata) {
    const Film::Window crop = film.crop();
    ImageHeader header{"openexr", crop, film.width(), film.height(), {}, {}};
    header.attributes = {{"compression", "zip"},
                         {"Software", fmt::format("woodcock {}", version())},
                         {"woodcock/sceneDigest", metadata.sceneDigest}};
    for (const MatteLayer& layer : mattes.layers()) {
        for (std::string& channel : matteChannels(layer))
            header.channels.push_back({std::move(channel)});
        for (auto& [name, text] : matteAttributes(layer))
            header.attributes.emplace_back(name, text);
    }
    constexpr std::size_t ofLayer = 2 * matteRanks;
    std::vector<float> pixels(static_cast<std::size_t>(crop.width()) *
                              static_cast<std::size_t>(crop.height()) * header.channels.size());
    std::span<float> to(pixels);
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x)
            for (std::size_t layer = 0; layer < mattes.layers().size(); ++layer) {
                mattes.ranks(layer, x, y, film.at(x, y).samples, to.first(ofLayer));
                to = to.subspan(ofLayer);
            }
    writeWholeFile(file, encodeImage(header, pixels));
}

}  // namespace woodcock::image
