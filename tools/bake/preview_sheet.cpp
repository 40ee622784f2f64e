// SPDX-License-Identifier: Apache-2.0
#include "tools/bake/preview_sheet.h"

#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tools/bake/preview.h"
#include "tools/common/interrupt.h"
#include "woodcock/bake/bake_file.h"
#include "woodcock/base/error.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/image/display.h"
#include "woodcock/image/encode_image.h"
#include "woodcock/image/image_format.h"

namespace woodcock::tool {

namespace {

constexpr int columns = 4, cellWidth = 300, cellHeight = 260;
constexpr double cellSeconds = 15;

/// The pictures side by side, scene-linear.
class Sheet {
public:
    explicit Sheet(std::size_t count)
        : rows_((static_cast<int>(count) + columns - 1) / columns),
          rgba_(4 * std::size_t(width()) * std::size_t(height())) {}

    int width() const { return columns * cellWidth; }
    int height() const { return rows_ * cellHeight; }

    void put(int index, const image::Film& film) {
        const int left = index % columns * cellWidth, top = index / columns * cellHeight;
        for (int y = 0; y < cellHeight; ++y)
            for (int x = 0; x < cellWidth; ++x) {
                const Rgb colour = film.radiance(x, y);
                const auto at =
                    4 * (std::size_t(top + y) * std::size_t(width()) + std::size_t(left + x));
                for (int c = 0; c < 3; ++c) rgba_[at + std::size_t(c)] = colour[c];
            }
    }

    std::vector<unsigned char> encoded(const std::filesystem::path& picture) const {
        std::vector<float> rgba = rgba_;
        image::ColorConfig("").displayTransform({}).apply(rgba);
        std::vector<float> rgb;
        for (std::size_t i = 0; i < rgba.size(); i += 4)
            rgb.insert(rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
        image::ImageHeader header{
            image::imageFormat(picture) == image::ImageFormat::Jpeg ? "jpeg" : "png",
            {0, 0, width(), height()},
            width(),
            height(),
            {},
            {{"CompressionQuality", 90}}};
        for (const char* name : {"R", "G", "B"})
            header.channels.push_back({name, image::PixelType::UInt8});
        return image::encodeImage(header, rgb);
    }

private:
    int rows_;
    std::vector<float> rgba_;
};

}  // namespace

void checkSheet(const std::filesystem::path& picture) {
    if (image::imageFormat(picture) == image::ImageFormat::Exr)
        throw usageError("--sheet {}: a sheet is a PNG or JPEG picture", picture.string());
    checkWritable(picture);
}

bool writeSheet(const std::filesystem::path& picture, const SheetSettings& settings,
                ProgressStyle style) {
    const TempDir scratch;
    const std::filesystem::path volume = scratch.path() / "preset.vdb";
    Sheet sheet(bake::presets().size());
    ProgressBar progress(style, "sheet");
    std::vector<std::string> names;
    for (const auto& [name, text] : bake::presets()) {
        const auto index = static_cast<int>(names.size());
        names.push_back(name);
        const bake::Recipe recipe = bake::makeRecipe({std::string(text), name, ""}, {});
        const Vec3d size = recipe.bounds.size();
        bake::BakeSettings how = bake::cubicVoxels(std::max({size.x, size.y, size.z}) /
                                                   std::max(1, settings.resolution - 1));
        how.threads = settings.threads;
        const double share = 1.0 / static_cast<double>(bake::presets().size());
        const std::optional<bake::Bake> bake = bake::bakeRecipe(recipe, how, [&](double done) {
            progress.update(share * (index + 0.3 * done));
            return !interrupted();
        });
        if (!bake) return false;
        bake::writeBake(volume, *bake, {}, 0);
        const std::optional<image::Film> film = renderPreview(
            recipe, *bake, volume, {cellWidth, cellHeight, cellSeconds, settings.threads},
            ProgressStyle::None);
        if (!film || interrupted()) return false;
        sheet.put(index, *film);
        spdlog::debug("{}: {} voxels", name, bake->statistics.front().activeVoxels);
    }
    writeWholeFile(picture, sheet.encoded(picture));
    spdlog::info("wrote {}: {}", picture.string(), fmt::join(names, ", "));
    return true;
}

}  // namespace woodcock::tool
