// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/build.h"

#include <algorithm>

#include "woodcock/base/error.h"
#include "woodcock/scene/check_surfaces.h"
#include "woodcock/scene/overrides.h"

namespace woodcock::scene {
namespace {

light::Light buildLight(const SunDescription& sun, light::EnvironmentMap&&) {
    return light::Sun(sun.direction, sun.irradiance, sun.angularDiameter, sun.visible);
}
light::Light buildLight(const EnvironmentDescription& environment, light::EnvironmentMap&& map) {
    if (map.empty()) return light::Environment(environment.radiance, environment.visible);
    return light::Environment(std::move(map), environment.radiance, worldFromLight(environment),
                              environment.visible);
}
light::Light buildLight(const PointDescription& point, light::EnvironmentMap&&) {
    return light::PointLight{point.position, point.intensity};
}
light::Light buildLight(const SphereDescription& sphere, light::EnvironmentMap&&) {
    return light::SphereLight{sphere.position, sphere.radius, sphere.radiance, sphere.visible};
}

light::LightSet buildLights(const SceneDescription& description,
                            std::vector<light::EnvironmentMap> maps, BuiltSurfaces& surfaces) {
    std::vector<light::Light> lights;
    maps.resize(description.lights.size());  // lights that were chosen after loading have no image
    for (size_t i = 0; i < maps.size(); ++i)
        lights.push_back(
            std::visit([&](const auto& light) { return buildLight(light, std::move(maps[i])); },
                       description.lights[i].light));
    if (!surfaces.emitters.empty())
        lights.push_back(
            light::MeshLight(std::move(surfaces.emitters), std::move(surfaces.radianceAt)));
    return light::LightSet(std::move(lights));
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

bool glows(const VolumeDescription& volume) {
    return (volume.emission && volume.emission->scale.maximum() > 0) ||
           (volume.blackbody && volume.blackbody->intensity > 0);
}

}  // namespace

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

Affine3d worldFromLight(const EnvironmentDescription& environment) {
    // A quarter turn about x takes the image's up, +y, to +z.
    const Affine3d up = environment.up == UpAxis::Z
                            ? Affine3d{{Vec3d{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}, {}}
                            : Affine3d();
    return up * Affine3d::rotate(1, environment.rotation);
}

render::Scene buildScene(const SceneDescription& description, LoadedScene loaded,
                         std::vector<std::string>* notes) {
    const camera::Camera camera = buildCamera(description.camera);
    for (std::string& note : coarsenForCamera(description, camera, loaded))
        if (notes) notes->push_back(std::move(note));
    BuiltSurfaces surfaces = buildSurfaces(description, loaded);
    return {buildMedium(description, loaded, ""),
            buildLights(description, std::move(loaded.environmentMaps), surfaces), camera,
            std::move(surfaces.set), std::move(surfaces.interiorMedia)};
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
    const auto isSeen = [](const LightDescription& light) {
        if (const auto* sun = std::get_if<SunDescription>(&light.light)) return sun->visible;
        if (const auto* sphere = std::get_if<SphereDescription>(&light.light))
            return sphere->visible;
        return false;
    };
    return anyVolumeOrSurfaceGlows(scene) ||
           std::any_of(scene.lights.begin(), scene.lights.end(), isSeen);
}

bool environmentIsHidden(const SceneDescription& scene) {
    bool hidden = true;
    for (const LightDescription& light : foreseenLights(scene))
        if (const auto* environment = std::get_if<EnvironmentDescription>(&light.light))
            hidden &= !environment->visible;
    return hidden;
}

}  // namespace woodcock::scene
