// SPDX-License-Identifier: Apache-2.0
#include "tests/support/render_scene.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tests/support/paths.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/parse.h"

namespace woodcock::test {

namespace {

using Json = nlohmann::json;

Vec3d vectorOf(const Json& j) { return {j.at(0), j.at(1), j.at(2)}; }
Rgb colourOf(const Json& j) { return {j.at(0), j.at(1), j.at(2)}; }

VolumeDescription volumeOf(const Json& j) {
    const Json& c = j.at("coefficients");
    VolumeDescription volume;
    volume.file = sharedDir() / "assets" / j.at("file").get<std::string>();
    volume.coefficients =
        SeparateCoefficients{GridCoefficient{c.at("grid"), colourOf(c.at("sigma_a"))},
                             GridCoefficient{c.at("grid"), colourOf(c.at("sigma_s"))}};
    volume.g = c.at("g");
    if (j.contains("object_to_world")) {
        const Json& rows = j["object_to_world"];
        Affine3d& m = volume.worldFromObject;
        for (std::size_t i = 0; i < 3; ++i) {
            for (int k = 0; k < 3; ++k) m.column[i][k] = rows.at(static_cast<std::size_t>(k)).at(i);
            m.translation[static_cast<int>(i)] = rows.at(i).at(3);
        }
    }
    return volume;
}

LightDescription lightOf(const Json& j) {
    if (j.at("type") == "sun")
        return {SunDescription{vectorOf(j.at("direction")), colourOf(j.at("irradiance"))}};
    return {EnvironmentDescription{.radiance = colourOf(j.at("radiance"))}};
}

std::string text(Vec3d v) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x, v.y, v.z); }

/// The statistics of `value(x, y)` over the pixels of a film.
Estimate even(const Film& film, const std::function<double(int, int)>& value) {
    Moments m;
    const Film::Window crop = film.crop();
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x) m.add(value(x, y));
    return Estimate(m);
}

}  // namespace

Scene sceneFrom(const std::string& sceneText, const std::filesystem::path& directory) {
    const SceneDescription description = parseSceneText(sceneText, "scene.toml", directory);
    return buildScene(description, loadScene(description));
}

Scene peerScene(const std::string& name) {
    const Json j = Json::parse(readText(sharedDir() / "images" / (name + ".json")));
    SceneDescription scene;
    for (const Json& volume : j.at("volumes")) scene.volumes.push_back(volumeOf(volume));
    for (const Json& light : j.at("lights")) scene.lights.push_back(lightOf(light));
    const Json& camera = j.at("camera");
    scene.camera.pose = LookAt{vectorOf(camera.at("eye")), vectorOf(camera.at("look_at")),
                               vectorOf(camera.at("up"))};
    scene.camera.fovY = camera.at("fov_y");
    return buildScene(scene, loadScene(scene));
}

Scene withParts(const Scene& scene, const std::function<void(MediumPart::Description&)>& edit) {
    Scene edited = scene;
    edited.medium.parts.clear();
    for (const MediumPart& part : scene.medium.parts) {
        MediumPart::Description d = part.description();
        edit(d);
        edited.medium.parts.emplace_back(std::move(d));
    }
    return edited;
}

RenderResult renderScene(const Scene& scene, const Picture& picture) {
    RenderSettings settings;
    settings.width = picture.width, settings.height = picture.height;
    settings.endSample = picture.samples;
    settings.seed = picture.seed;
    settings.maxScatterings = picture.maxScatterings;
    RenderResult result = render(scene, settings);
    EXPECT_EQ(result.film.nonFiniteCount(), 0u);
    return result;
}

RgbEstimate evenRadiance(const Film& film) {
    RgbEstimate e;
    for (int c = 0; c < 3; ++c)
        e[static_cast<std::size_t>(c)] = even(film, [&](int x, int y) {
            const Film::Pixel& p = film.at(x, y);
            return p.radiance[c] / static_cast<double>(p.samples);
        });
    return e;
}

Estimate evenAlpha(const Film& film) {
    return even(film, [&](int x, int y) {
        const Film::Pixel& p = film.at(x, y);
        return p.alpha / static_cast<double>(p.samples);
    });
}

double meanRadiance(const Film& film, int channel) {
    return evenRadiance(film)[static_cast<std::size_t>(channel)].mean;
}

Estimate meanOverSeeds(const Scene& scene, Picture picture, int seeds,
                       const std::function<double(const Film&)>& measure) {
    Moments m;
    for (int i = 0; i < seeds; ++i, ++picture.seed)
        m.add(measure(renderScene(scene, picture).film));
    return Estimate(m);
}

RgbEstimate meanOverSeeds(const Scene& scene, Picture picture, int seeds) {
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

}  // namespace woodcock::test
