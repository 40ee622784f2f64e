// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/support/render_scene.h"

#include <fmt/format.h>

#include <stdexcept>

#include "woodcock/scene/build.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::proof {

namespace {

std::string text(Vec3d v) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x, v.y, v.z); }

/// The statistics of `value(x, y)` over the pixels of a film.
Estimate even(const image::Film& film, const std::function<double(int, int)>& value) {
    Moments m;
    const image::Film::Window crop = film.crop();
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x) m.add(value(x, y));
    return Estimate(m);
}

}  // namespace

render::Scene sceneFrom(const std::string& sceneText, const std::filesystem::path& directory) {
    const scene::SceneDescription description =
        scene::parseSceneText(sceneText, "scene.toml", directory);
    return scene::buildScene(description, scene::loadScene(description));
}

render::Scene withParts(const render::Scene& scene,
                        const std::function<void(medium::MediumPart::Description&)>& edit) {
    render::Scene edited = scene;
    edited.medium.parts.clear();
    for (const medium::MediumPart& part : scene.medium.parts) {
        medium::MediumPart::Description d = part.description();
        edit(d);
        edited.medium.parts.emplace_back(std::move(d));
    }
    return edited;
}

namespace {

bool adaptiveSamples = false;

}  // namespace

void sampleAdaptively(bool adaptive) { adaptiveSamples = adaptive; }

render::RenderResult renderScene(const render::Scene& scene, const Picture& picture) {
    render::RenderSettings settings;
    settings.adaptive = adaptiveSamples;
    settings.width = picture.width, settings.height = picture.height;
    settings.endSample = picture.samples * (adaptiveSamples ? 2 : 1);
    settings.seed = picture.seed;
    settings.maxScatterings = picture.maxScatterings;
    settings.layers.depth = picture.depthLayers;
    settings.layers.features = picture.featureLayers;
    render::RenderResult result = render::render(scene, settings);
    if (const auto count = result.film.nonFiniteCount())
        throw std::runtime_error(fmt::format("{} samples are not finite", count));
    return result;
}

RgbEstimate evenRadiance(const image::Film& film) {
    RgbEstimate e;
    for (int c = 0; c < 3; ++c)
        e[static_cast<std::size_t>(c)] = even(film, [&](int x, int y) {
            const image::Film::Pixel& p = film.at(x, y);
            return p.radiance[c] / static_cast<double>(p.samples);
        });
    return e;
}

Estimate evenAlpha(const image::Film& film) {
    return even(film, [&](int x, int y) {
        const image::Film::Pixel& p = film.at(x, y);
        return p.alpha / static_cast<double>(p.samples);
    });
}

RgbEstimate evenTransmittance(const image::Film& film) {
    RgbEstimate e;
    for (int c = 0; c < 3; ++c)
        e[static_cast<std::size_t>(c)] = even(film, [&](int x, int y) {
            const image::Film::Pixel& p = film.at(x, y);
            return p.transmittance[c] / static_cast<double>(p.depthSamples);
        });
    return e;
}

double meanRadiance(const image::Film& film, int channel) {
    return evenRadiance(film)[static_cast<std::size_t>(channel)].mean;
}

Estimate meanOverSeeds(const render::Scene& scene, Picture picture, int seeds,
                       const std::function<double(const image::Film&)>& measure) {
    Moments m;
    for (int i = 0; i < seeds; ++i, ++picture.seed)
        m.add(measure(renderScene(scene, picture).film));
    return Estimate(m);
}

RgbEstimate meanOverSeeds(const render::Scene& scene, Picture picture, int seeds) {
    std::array<Moments, 3> m;
    for (int i = 0; i < seeds; ++i, ++picture.seed) {
        const RgbEstimate e = evenRadiance(renderScene(scene, picture).film);
        for (std::size_t c = 0; c < 3; ++c) m[c].add(e[c].mean);
    }
    return {Estimate(m[0]), Estimate(m[1]), Estimate(m[2])};
}

std::string pencilCamera(Vec3d eye, Vec3d direction) {
    const Vec3d d = normalize(direction);
    const Vec3d up = std::abs(d.y) < 0.5 ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
    return fmt::format(
        "[camera]\ntype = \"orthographic\"\nheight = 1e-12\n"
        "eye = {}\nlook_at = {}\nup = {}\n",
        text(eye), text(eye + d), text(up));
}

}  // namespace woodcock::proof
