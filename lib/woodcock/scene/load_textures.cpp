// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/load_textures.h"

#include <cmath>
#include <map>
#include <optional>

#include "woodcock/image/read_texture.h"

namespace woodcock::scene {
namespace {

/// What a colour space conversion of white may give.
constexpr float almostOne = 1 + 1e-4f;

/// Reads images, each once.
class Reader {
public:
    explicit Reader(const SceneDescription& scene) : scene_(scene) {}

    std::shared_ptr<const surface::TextureImage> read(const std::filesystem::path& file,
                                                      const std::string& colourSpace,
                                                      const std::string& place) {
        auto& image = known_[{file, colourSpace}];
        if (image) return image;
        if (!config_)
            inPlace(findPlace(scene_.places, "ocio"), [&] { config_.emplace(scene_.ocio); });
        inPlace(place, [&] {
            image::Image read = image::readTexture(file, colourSpace, *config_);
            image = std::make_shared<surface::TextureImage>(read.width, read.height,
                                                            std::move(read.rgb));
        });
        return image;
    }

private:
    const SceneDescription& scene_;
    std::optional<image::ColorConfig> config_;
    std::map<std::pair<std::filesystem::path, std::string>,
             std::shared_ptr<const surface::TextureImage>>
        known_;
};

struct NamedTexture {
    const TextureDescription* texture = nullptr;
    const char* key = "";
    bool limited = true;  ///< to 1: it shares light out, and makes none
    bool isData = false;
};
NamedTexture textureOf(const DiffuseDescription& m) { return {&m.colour, "colour"}; }
NamedTexture textureOf(const ConductorDescription& m) { return {&m.colour, "colour"}; }
NamedTexture textureOf(const DielectricDescription&) { return {}; }
NamedTexture textureOf(const InterfaceDescription&) { return {}; }
NamedTexture textureOf(const EmissiveDescription& m) { return {&m.radiance, "radiance", false}; }
NamedTexture textureOf(const MixDescription& m) { return {&m.weight, "weight", true, true}; }

}  // namespace

surface::Texture makeTexture(const TextureDescription& description,
                             std::shared_ptr<const surface::TextureImage> image) {
    surface::Texture texture(description.colour, std::move(image));
    const float largest = texture.maximum().maximum();
    if (texture.image && largest > 1 && largest <= almostOne) texture.colour *= 1 / largest;
    return texture;
}

std::vector<std::shared_ptr<const surface::TextureImage>> loadTextures(
    const SceneDescription& scene) {
    std::vector<std::shared_ptr<const surface::TextureImage>> textures;
    Reader reader(scene);
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        const NamedTexture named =
            std::visit([](const auto& m) { return textureOf(m); }, scene.materials[i].material);
        textures.emplace_back();
        if (!named.texture || named.texture->image.empty()) continue;
        const std::string value = fmt::format("material[{}].{}", i, named.key);
        const auto placeOf = [&](const char* key) {
            return findPlace(scene.places, fmt::format("{}.{}", value, key));
        };
        // Weights are no colours: a mask of bytes means what it says.
        const bool data = named.isData && named.texture->colourSpace.empty();
        const auto image = reader.read(
            named.texture->image, data ? "data" : named.texture->colourSpace, placeOf("image"));
        textures.back() = image;
        const Rgb largest = named.texture->colour * image->maximum();
        if (!named.limited || largest.maximum() <= almostOne) continue;
        inPlace(placeOf(named.texture->colour == Rgb(1) ? "image" : "times"), [&] {
            throw inputError(
                "{} reaches {:.4g} with {}, but a {} is at most 1; give times = {:.3g} or less",
                value, largest.maximum(), named.texture->image.string(), named.key,
                std::floor(1000 / image->maximum().maximum()) / 1000);
        });
    }
    return textures;
}

}  // namespace woodcock::scene
