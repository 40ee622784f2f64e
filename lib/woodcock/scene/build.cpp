// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/build.h"

#include <algorithm>
#include <cmath>

#include "woodcock/base/error.h"
#include "woodcock/camera/projection.h"
#include "woodcock/image/write_exr.h"
#include "woodcock/light/graded_image.h"
#include "woodcock/scene/animation.h"
#include "woodcock/scene/check_surfaces.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/light_groups.h"
#include "woodcock/scene/next_frame.h"
#include "woodcock/scene/overrides.h"
#include "woodcock/scene/sky.h"

namespace woodcock::scene {
namespace {

light::Light buildLight(const SunDescription& sun, LoadedLight&&) {
    return light::Sun(sun.direction, sun.irradiance, sun.angularDiameter, sun.visible);
}
light::Light buildLight(const EnvironmentDescription& environment, LoadedLight&& loaded) {
    if (environment.graded())
        return light::Environment(
            {light::gradedImageWidth, light::gradedImageHeight, gradedImageOf(environment)},
            Rgb(1.0f), worldFromLight(environment), environment.visible);
    if (loaded.map.empty()) return light::Environment(environment.radiance, environment.visible);
    return light::Environment(std::move(loaded.map), environment.radiance,
                              worldFromLight(environment), environment.visible);
}
light::Light buildLight(const PointDescription& point, LoadedLight&& loaded) {
    if (!loaded.profile) return light::PointLight{point.position, point.intensity};
    // The lamp's y, where it shines, is -z of the profile, its z is +y there.
    const auto& [x, y, z] = point.axes().column;
    return light::PointLight{point.position, point.intensity, std::move(loaded.profile),
                             Affine3d{{x, z, -y}, {}}.inverse()};
}
light::Light buildLight(const SpotDescription& spot, LoadedLight&&) {
    return light::SpotLight(spot.position, spot.direction, spot.intensity, spot.cone, spot.blend);
}
light::Light buildLight(const SphereDescription& sphere, LoadedLight&&) {
    return light::SphereLight{sphere.position, sphere.radius, sphere.radiance, sphere.visible};
}

light::FlatLight flatLight(const FlatDescription& description, double sizeX, double sizeZ) {
    light::FlatLight flat = light::FlatLight::placed(description.worldFromLight, sizeX, sizeZ);
    flat.radiance = description.radiance;
    flat.spread = light::Spread(description.spread);
    flat.twoSided = description.twoSided;
    flat.visible = description.visible;
    return flat;
}
light::Light buildLight(const RectangleDescription& rectangle, LoadedLight&&) {
    return light::RectangleLight{flatLight(rectangle, rectangle.size[0], rectangle.size[1])};
}
light::Light buildLight(const DiskDescription& disk, LoadedLight&&) {
    return light::DiskLight{flatLight(disk, 2 * disk.radius, 2 * disk.radius)};
}

template <class L>
void addLights(std::vector<light::Light>& lights, const L& light, LoadedLight&& loaded) {
    lights.push_back(buildLight(light, std::move(loaded)));
}
void addLights(std::vector<light::Light>& lights, const EnvironmentDescription& environment,
               LoadedLight&& loaded) {
    if (auto sun = loaded.map.takeSun())
        lights.push_back(light::Environment(std::move(*sun), environment.radiance,
                                            worldFromLight(environment), environment.visible));
    lights.push_back(buildLight(environment, std::move(loaded)));
}
void addLights(std::vector<light::Light>& lights, const SkyDescription& sky, LoadedLight&&) {
    SkyParts parts = partsOf(sky);
    image::Image& image = parts.image;
    lights.push_back(
        buildLight(parts.environment, {.map = {image.width, image.height, std::move(image.rgb)}}));
    if (parts.sun) lights.push_back(buildLight(*parts.sun, {}));
}

light::LightSet buildLights(const SceneDescription& description, std::vector<LoadedLight> loaded,
                            const Movements& movements, BuiltSurfaces& surfaces) {
    const std::vector<std::string> names = lightGroups(description);
    std::vector<light::Light> lights;
    std::vector<std::uint8_t> groups;
    light::LightSet::Motions motions;
    loaded.resize(description.lights.size());  // lights that were chosen after loading have no file
    for (size_t i = 0; i < loaded.size(); ++i) {
        std::visit([&](const auto& light) { addLights(lights, light, std::move(loaded[i])); },
                   description.lights[i].light);
        motions.resize(lights.size());
        if (i < movements.lights.size()) motions.back() = movements.lights[i];
        groups.resize(lights.size(), groupNumber(names, description.lights[i].group));
    }
    if (!surfaces.emitters.empty())
        lights.push_back(light::MeshLight(std::move(surfaces.emitters),
                                          std::move(surfaces.radianceAt),
                                          std::move(surfaces.movingEmitters)));
    motions.resize(lights.size());
    return light::LightSet(std::move(lights), std::move(motions), std::move(groups));
}

/// As OpenEXR has it: 24/1, and 24000/1001 of 23.976.
image::Rational frameRate(double fps) {
    const auto near = [](double a) { return std::abs(a - std::round(a)) < 1e-3; };
    if (!near(fps) && near(fps * 1.001))
        return {static_cast<int>(std::round(fps * 1.001)) * 1000, 1001};
    const unsigned parts = near(fps) ? 1 : 1000;
    return {static_cast<int>(std::round(fps * parts)), parts};
}

bool glows(const VolumeDescription& volume) {
    return (volume.emission && volume.emission->scale.maximum() > 0) ||
           (volume.blackbody && volume.blackbody->intensity > 0);
}

}  // namespace

light::LightForm formOf(const LightDescription& light) {
    return std::visit(
        [](const auto& described) {
            if constexpr (requires { buildLight(described, {}); })
                return buildLight(described, {}).form();
            else
                return light::LightForm();
        },
        light.light);
}

camera::Camera buildCamera(const CameraDescription& description) {
    const bool orthographic = description.kind == CameraDescription::Kind::Orthographic;
    if (!description.pose || (orthographic && !description.height))
        throw usageError("the camera has not been placed yet");
    camera::Camera camera;
    camera.kind =
        orthographic ? camera::Camera::Kind::Orthographic : camera::Camera::Kind::Perspective;
    camera.worldFromCamera = worldFromCamera(*description.pose);
    camera.fovY = description.fovY;
    if (orthographic) camera.height = *description.height;
    camera.shiftX = description.shift[0];
    camera.shiftY = description.shift[1];
    return camera;
}

void describeShot(const SceneDescription& scene, image::RenderMetadata& metadata) {
    const camera::Camera camera = buildCamera(scene.camera);
    const auto floats = [](const camera::Matrix44d& m) {
        image::Matrix44 all;
        std::transform(m.begin(), m.end(), all.begin(),
                       [](double v) { return static_cast<float>(v); });
        return all;
    };
    metadata.worldToCamera = floats(camera::worldToCamera(camera));
    metadata.worldToNdc =
        floats(camera::worldToNdc(camera, double(scene.render.width) / scene.render.height));
    metadata.shutter = scene.camera.shutter.length();
    const std::string fps = fmt::format("render.{}", keyName(scene.render, scene.render.fps));
    const bool known = metadata.shutter > 0 || !findPlace(scene.places, fps).empty();
    if (known && scene.render.fps >= 1e-3 && scene.render.fps <= 1e6)
        metadata.framesPerSecond = frameRate(scene.render.fps);
}

render::RenderSettings renderSettings(const RenderDescription& render) {
    render::RenderSettings settings;
    settings.width = render.width;
    settings.height = render.height;
    settings.endSample = render.spp;
    settings.seed = render.seed;
    settings.maxScatterings = render.maxScatterings;
    settings.maxBounces = render.maxBounces;
    settings.approximations = render.approximations;
    settings.adaptive = render.adaptive.value_or(false);
    settings.timeLimit = render.timeLimit;
    settings.noise = render.noise;
    return settings;
}

Affine3d worldFromCamera(const CameraPose& pose) {
    if (const auto* matrix = std::get_if<Affine3d>(&pose)) return *matrix;
    const LookAt& lookAt = std::get<LookAt>(pose);
    return camera::lookAtTransform(lookAt.eye, lookAt.target, lookAt.up);
}

std::vector<float> gradedImageOf(const EnvironmentDescription& environment) {
    const Rgb horizon = environment.radiance;
    return light::gradedImage(environment.below.value_or(horizon), horizon,
                              environment.above.value_or(horizon));
}

Affine3d worldFromLight(const EnvironmentDescription& environment) {
    // A quarter turn about x takes the image's up, +y, to +z.
    const Affine3d up = environment.up == UpAxis::Z
                            ? Affine3d{{Vec3d{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}, {}}
                            : Affine3d();
    return up * Affine3d::rotate(1, environment.rotation);
}

render::Scene buildScene(const SceneDescription& description, LoadedScene loaded,
                         std::vector<std::string>* notes) {
    if (const camera::Shutter& shutter = description.camera.shutter;
        !description.animation.empty() && shutter.length() == 0 && shutter.open != 0) {
        // A shutter of no length, beside the frame: the scene stands still at that moment.
        SceneDescription moment = atFrame(description, description.frame + shutter.open);
        std::shared_ptr<const render::NextFrame> next;
        if (asksForMotion(description)) next = buildNextFrame(moment, loaded);
        moment.animation.clear();
        render::Scene scene = buildScene(moment, std::move(loaded), notes);
        scene.next = std::move(next);
        return scene;
    }
    camera::Camera camera = buildCamera(description.camera);
    for (std::string& note : coarsenForCamera(description, camera, loaded))
        if (notes) notes->push_back(std::move(note));
    const Movements movements = findMovements(description, loaded);
    camera.motion = movements.camera;
    BuiltSurfaces surfaces = buildSurfaces(description, loaded, movements);
    medium::Medium medium = buildMedium(description, loaded, movements, "");
    std::shared_ptr<const render::NextFrame> next;
    if (asksForMotion(description)) next = buildNextFrame(description, loaded);
    if (notes)
        for (std::string& note : motionNotes(description, loaded, medium, ""))
            notes->push_back(std::move(note));
    std::vector<std::vector<std::uint32_t>> owners(1);
    for (const size_t volume : volumesOfParts(description, loaded, ""))
        owners[0].push_back(static_cast<std::uint32_t>(volume));
    std::move(surfaces.partOwners.begin(), surfaces.partOwners.end(), std::back_inserter(owners));
    return {.medium = std::move(medium),
            .lights = buildLights(description, std::move(loaded.lights), movements, surfaces),
            .camera = camera,
            .surfaces = std::move(surfaces.set),
            .interiorMedia = std::move(surfaces.interiorMedia),
            .shutter = description.camera.shutter,
            .next = std::move(next),
            .partOwners = std::move(owners),
            .firstSurface = static_cast<std::uint32_t>(description.volumes.size())};
}

bool anyVolumeOrSurfaceGlows(const SceneDescription& scene) {
    const auto interior = [](const SurfaceDescription& surface) {
        return surface.interior && surface.interior->emission.maximum() > 0;
    };
    return std::any_of(scene.volumes.begin(), scene.volumes.end(), glows) ||
           std::any_of(scene.surfaces.begin(), scene.surfaces.end(), interior) ||
           anySurfaceEmits(scene);
}

bool anythingGlows(const SceneDescription& scene) {
    return anyVolumeOrSurfaceGlows(scene) ||
           std::any_of(scene.lights.begin(), scene.lights.end(),
                       [](const LightDescription& light) { return light.glows(); });
}

bool environmentIsHidden(const SceneDescription& scene) {
    bool hidden = true;
    for (const LightDescription& light : foreseenLights(scene)) {
        if (const auto* environment = std::get_if<EnvironmentDescription>(&light.light))
            hidden &= !environment->visible;
        if (const auto* sky = std::get_if<SkyDescription>(&light.light)) hidden &= !sky->visible;
    }
    return hidden;
}

}  // namespace woodcock::scene
