// SPDX-License-Identifier: Apache-2.0
#include "tools/render/picture_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/common/progress.h"
#include "woodcock/grid/motion.h"
#include "woodcock/grid/moved_ranges.h"
#include "woodcock/image/image_format.h"
#include "woodcock/render/view_depth.h"
#include "woodcock/scene/build.h"

namespace woodcock::tool {

namespace {

bool anyLightShines(const scene::SceneDescription& scene) {
    return std::any_of(scene.lights.begin(), scene.lights.end(),
                       [](const auto& light) { return light.brightness().maximum() > 0; });
}

struct Brightest {
    float light = 0, alpha = 0;
};

Brightest brightestOf(const image::Film& film) {
    Brightest most;
    const image::Film::Window crop = film.crop();
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x) {
            most.light = std::max(most.light, film.radiance(x, y).maximum());
            most.alpha = std::max(most.alpha, film.alpha(x, y));
        }
    return most;
}

}  // namespace

PictureWarnings::PictureWarnings(const scene::SceneDescription& description,
                                 const scene::LoadedScene& loaded)
    : description_(description), volumesOfParts_(scene::volumesOfParts(description, loaded, "")) {}

std::string PictureWarnings::volumeName(std::size_t part) const {
    if (part >= volumesOfParts_.size()) return "a volume";
    const std::size_t index = volumesOfParts_[part];
    const std::string file = description_.volumes[index].file.filename().string();
    return fmt::format("volume[{}] ({})", index, file.empty() ? "a box" : file);
}

std::string PictureWarnings::ofCamera(const render::Scene& scene) {
    const auto view =
        render::findClosedView(scene, description_.render.width, description_.render.height);
    if (!view) return {};
    camera_ = "the camera stands inside " + volumeName(view->part);
    return fmt::format(
        "{}, where light goes {:.3g} units between two collisions, and the view has an optical "
        "depth of {:.3g}: it shows what is next to the camera, and nothing else. Move camera.eye "
        "out of it, leave the camera out of the scene to have one chosen, or lower the volume's "
        "scale",
        camera_, view->meanFreePath, view->depth);
}

std::vector<std::string> PictureWarnings::ofMotion(const render::Scene& scene) const {
    std::vector<std::string> warnings;
    for (std::size_t i = 0; i < scene.medium.parts.size(); ++i) {
        const medium::MediumPart& part = scene.medium.parts[i];
        if (!part.moved()) continue;
        const grid::Motion& motion = *part.description().motion;
        const Vec3d size = part.field()->extent().size();
        const double widest = std::max({size.x, size.y, size.z});
        const double voxels = motion.mostVoxels();
        if (!(voxels > widest)) continue;
        const Vec3i at = motion.velocity().fastest().voxel;
        warnings.push_back(fmt::format(
            "{}: its velocity at voxel [{}, {}, {}] moves by {:.3g} voxels while the shutter is "
            "open, and the volume is {:.3g} wide. Nothing is cut off, but {:.0f} % of its blocks "
            "have loose bounds, which take time. Look at velocity_unit, velocity_scale and "
            "render.fps, or at that voxel",
            volumeName(i), at.x, at.y, at.z, voxels, widest, 100 * part.moved()->looseShare()));
    }
    return warnings;
}

std::string PictureWarnings::whyNoLight(const render::Scene& scene,
                                        const render::RenderResult& result, float alpha) const {
    const bool glow = scene::anyVolumeOrSurfaceGlows(description_);
    if (!anyLightShines(description_) && !glow)
        return "the scene has no light: give a [[light]] that shines";
    if (alpha == 0)
        return "nothing of the scene is in the picture, and no sky is seen behind it: look at "
               "camera.eye and camera.look_at, or leave the camera out to have one chosen";
    if (!camera_.empty()) return camera_ + ", and no light comes through to it";
    if (!result.needs.scattering && !scene.surfaces)
        return "the volumes only absorb (their albedo is 0), and nothing that shines is seen "
               "behind them";
    if (description_.render.maxScatterings == 0 && !scene.surfaces)
        return "render.max_scatterings is 0, so nothing is seen of light that a volume scatters";
    return "no light reached what the camera sees: lights of no size do not shine through glass, "
           "and little comes out of deep media that absorb";
}

std::string PictureWarnings::ofPicture(const render::Scene& scene,
                                       const render::RenderResult& result) const {
    const Brightest most = brightestOf(result.film);
    if (most.light == 0) return "the picture is black: " + whyNoLight(scene, result, most.alpha);
    // Half a step of a byte in the straight part of sRGB's curve.
    constexpr double darkest = 0.5 / 255 / 12.92;
    const auto& files = description_.output.files;
    const double shown = double{most.light} * std::exp2(description_.output.exposure);
    if (shown >= darkest || std::none_of(files.begin(), files.end(), [](const auto& file) {
            return image::imageFormat(file) != image::ImageFormat::Exr;
        }))
        return {};
    return fmt::format(
        "the picture is black, as its brightest pixel is {:.2g} and the exposure {:+g}: "
        "--exposure {:+.0f} would show it",
        most.light, description_.output.exposure, std::round(std::log2(0.5 / most.light)));
}

std::string noiseOf(const render::RenderResult& result) {
    const double noise = result.film.noise();
    if (std::isfinite(noise)) return noiseText(noise);
    return result.film.mostSamples() < 2 ? "noise unknown (it takes two samples a pixel)"
                                         : "noise unknown (no pixel has any light)";
}

}  // namespace woodcock::tool
