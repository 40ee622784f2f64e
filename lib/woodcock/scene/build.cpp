// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/build.h"

#include "woodcock/base/error.h"

namespace woodcock {
namespace {

using Part = MediumPart::Description;

Part fieldPart(const VolumeDescription& volume, const LoadedField& loaded) {
    Part part;
    part.field = loaded.field;
    part.worldFromIndex = volume.worldFromObject * loaded.objectFromIndex;
    return part;
}

std::vector<Part> parts(const VolumeDescription& volume, const DensityCoefficients& c,
                        const LoadedVolume& loaded) {
    if (!c.scale) throw usageError("a volume's scale has not been chosen yet");
    Part part = fieldPart(volume, loaded.density);
    std::tie(part.absorption, part.scattering) = splitByAlbedo(*c.scale, c.albedo);
    if (loaded.albedo) {
        part.albedo = loaded.albedo.field;
        part.albedoWorldFromIndex = volume.worldFromObject * loaded.albedo.objectFromIndex;
    }
    return {part};
}

std::vector<Part> parts(const VolumeDescription& volume, const SeparateCoefficients& c,
                        const LoadedVolume& loaded) {
    std::vector<Part> all;
    if (c.sigmaA) {
        all.push_back(fieldPart(volume, loaded.sigmaA));
        all.back().absorption = c.sigmaA->scale;
        all.back().scattering = Rgb(0);
    }
    if (c.sigmaS) {
        const bool sameGrid = c.sigmaA && loaded.sigmaA.field == loaded.sigmaS.field;
        if (!sameGrid) all.push_back(fieldPart(volume, loaded.sigmaS));
        all.back().scattering = c.sigmaS->scale;
    }
    return all;
}

std::vector<Part> parts(const VolumeDescription& volume, const HomogeneousBox& c,
                        const LoadedVolume&) {
    Part part;
    part.box = c.box;
    part.worldFromIndex = volume.worldFromObject;
    part.absorption = c.sigmaA;
    part.scattering = c.sigmaS;
    return {part};
}

Medium buildMedium(const SceneDescription& description, const LoadedScene& loaded) {
    Medium medium;
    for (size_t i = 0; i < description.volumes.size(); ++i) {
        const VolumeDescription& volume = description.volumes[i];
        const auto all =
            std::visit([&](const auto& c) { return parts(volume, c, loaded.volumes[i]); },
                       volume.coefficients);
        for (Part part : all) {
            if ((part.absorption + part.scattering).maximum() == 0) continue;
            part.g = volume.g;
            part.majorantScale = description.render.majorantScale;
            medium.parts.emplace_back(std::move(part));
        }
    }
    return medium;
}

Light buildLight(const SunDescription& sun, EnvironmentMap&&) {
    return Sun(sun.direction, sun.irradiance, sun.angularDiameter, sun.visible);
}
Light buildLight(const EnvironmentDescription& environment, EnvironmentMap&& map) {
    if (map.empty()) return Environment(environment.radiance, environment.visible);
    // A quarter turn about x takes the image's up, +y, to +z.
    const Affine3d up = environment.up == UpAxis::Z
                            ? Affine3d{{Vec3d{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}, {}}
                            : Affine3d();
    return Environment(std::move(map), environment.radiance,
                       up * Affine3d::rotate(1, environment.rotation), environment.visible);
}
Light buildLight(const PointDescription& point, EnvironmentMap&&) {
    return PointLight{point.position, point.intensity};
}
Light buildLight(const SphereDescription& sphere, EnvironmentMap&&) {
    return SphereLight{sphere.position, sphere.radius, sphere.radiance, sphere.visible};
}

LightSet buildLights(const SceneDescription& description, std::vector<EnvironmentMap> maps) {
    std::vector<Light> lights;
    maps.resize(description.lights.size());  // lights that were chosen after loading have no image
    for (size_t i = 0; i < maps.size(); ++i)
        lights.push_back(
            std::visit([&](const auto& light) { return buildLight(light, std::move(maps[i])); },
                       description.lights[i].light));
    return LightSet(std::move(lights));
}

Camera buildCamera(const CameraDescription& description) {
    const bool orthographic = description.kind == CameraDescription::Kind::Orthographic;
    if (!description.pose || (orthographic && !description.height))
        throw usageError("the camera has not been placed yet");
    Camera camera;
    camera.kind = orthographic ? Camera::Kind::Orthographic : Camera::Kind::Perspective;
    camera.worldFromCamera = worldFromCamera(*description.pose);
    camera.fovY = description.fovY;
    if (orthographic) camera.height = *description.height;
    return camera;
}

}  // namespace

Affine3d worldFromCamera(const CameraPose& pose) {
    if (const auto* matrix = std::get_if<Affine3d>(&pose)) return *matrix;
    const LookAt& lookAt = std::get<LookAt>(pose);
    return lookAtTransform(lookAt.eye, lookAt.target, lookAt.up);
}

Scene buildScene(const SceneDescription& description, LoadedScene loaded) {
    return {buildMedium(description, loaded),
            buildLights(description, std::move(loaded.environmentMaps)),
            buildCamera(description.camera)};
}

}  // namespace woodcock
