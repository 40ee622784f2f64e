// SPDX-License-Identifier: Apache-2.0
#include "tests/support/peer_scene.h"

#include <nlohmann/json.hpp>

#include "tests/support/paths.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/load.h"

namespace woodcock::test {

using namespace render;
using namespace scene;

namespace {

using Json = nlohmann::json;

Vec3d vectorOf(const Json& j) { return {j.at(0), j.at(1), j.at(2)}; }
Rgb colourOf(const Json& j) { return {j.at(0), j.at(1), j.at(2)}; }

void addCoefficients(const Json& c, VolumeDescription& volume) {
    volume.coefficients =
        SeparateCoefficients{GridCoefficient{c.at("grid"), colourOf(c.at("sigma_a"))},
                             GridCoefficient{c.at("grid"), colourOf(c.at("sigma_s"))}};
    volume.g = c.at("g");
}

/// Cycles' Principled Volume, without colours above 1 and without an absorption colour.
void addPrincipled(const Json& p, VolumeDescription& volume) {
    const Rgb albedo = colourOf(p.at("color"));
    DensityCoefficients c;
    c.density = p.at("density_attribute");
    c.scale = Rgb(p.at("density").get<float>());
    c.albedo = {albedo[0], albedo[1], albedo[2]};
    volume.coefficients = c;
    volume.g = p.at("anisotropy");
    BlackbodyDescription b;
    b.temperature = p.at("temperature_attribute");
    b.scale = p.at("temperature");
    b.intensity = p.at("blackbody_intensity");
    volume.blackbody = b;
}

VolumeDescription volumeOf(const Json& j) {
    VolumeDescription volume;
    volume.file = sharedDir() / "assets" / j.at("file").get<std::string>();
    if (j.contains("principled"))
        addPrincipled(j.at("principled"), volume);
    else
        addCoefficients(j.at("coefficients"), volume);
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

}  // namespace

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

}  // namespace woodcock::test
