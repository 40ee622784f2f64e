// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/load_textures.h"

#include <cmath>
#include <map>

#include "woodcock/image/read_image.h"

namespace woodcock {
namespace {

/// What a colour space conversion of white may give.
constexpr float almostOne = 1 + 1e-4f;

std::shared_ptr<const TextureImage> readTextureImage(const TextureDescription& texture,
                                                     const std::filesystem::path&) {
    Image image = readImage(texture.image);
    return std::make_shared<TextureImage>(image.width, image.height, std::move(image.rgb));
}

struct NamedTexture {
    const TextureDescription* texture = nullptr;
    const char* key = "";
    bool reflects = true;  ///< and so must not exceed 1
};
NamedTexture textureOf(const DiffuseDescription& m) { return {&m.colour, "colour"}; }
NamedTexture textureOf(const ConductorDescription& m) { return {&m.colour, "colour"}; }
NamedTexture textureOf(const DielectricDescription&) { return {}; }
NamedTexture textureOf(const InterfaceDescription&) { return {}; }
NamedTexture textureOf(const EmissiveDescription& m) { return {&m.radiance, "radiance", false}; }
NamedTexture textureOf(const MixDescription& m) { return {&m.weight, "weight"}; }

}  // namespace

Texture makeTexture(const TextureDescription& description,
                    std::shared_ptr<const TextureImage> image) {
    Texture texture(description.colour, std::move(image));
    const float largest = texture.maximum().maximum();
    if (texture.image && largest > 1 && largest <= almostOne) texture.colour *= 1 / largest;
    return texture;
}

std::vector<std::shared_ptr<const TextureImage>> loadTextures(const SceneDescription& scene) {
    std::vector<std::shared_ptr<const TextureImage>> textures;
    std::map<std::pair<std::filesystem::path, std::string>, std::shared_ptr<const TextureImage>>
        known;
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        const NamedTexture named =
            std::visit([](const auto& m) { return textureOf(m); }, scene.materials[i].material);
        textures.emplace_back();
        if (!named.texture || named.texture->image.empty()) continue;
        const std::string value = fmt::format("material[{}].{}", i, named.key);
        const auto placeOf = [&](const char* key) {
            return findPlace(scene.places, fmt::format("{}.{}", value, key));
        };
        auto& image = known[{named.texture->image, named.texture->colourSpace}];
        inPlace(placeOf("image"), [&] {
            if (!image) image = readTextureImage(*named.texture, scene.ocio);
        });
        textures.back() = image;
        const Rgb largest = named.texture->colour * image->maximum();
        if (!named.reflects || largest.maximum() <= almostOne) continue;
        inPlace(placeOf(named.texture->colour == Rgb(1) ? "image" : "times"), [&] {
            throw inputError(
                "{} reaches {:.4g} with {}, but a {} is at most 1; give times = {:.3g} or less",
                value, largest.maximum(), named.texture->image.string(), named.key,
                std::floor(999 / image->maximum().maximum()) / 1000);
        });
    }
    return textures;
}

}  // namespace woodcock
