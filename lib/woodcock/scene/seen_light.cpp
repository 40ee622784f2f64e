// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/seen_light.h"

#include <algorithm>

#include "woodcock/scene/check_surfaces.h"
#include "woodcock/scene/overrides.h"

namespace woodcock::scene {
namespace {

bool glows(const VolumeDescription& volume) {
    return (volume.emission && volume.emission->scale.maximum() > 0) ||
           (volume.blackbody && volume.blackbody->intensity > 0);
}

}  // namespace

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
