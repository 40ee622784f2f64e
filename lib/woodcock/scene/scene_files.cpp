// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/scene_files.h"

namespace woodcock::scene {
namespace {

TextureDescription* textureOf(MaterialDescription& material) {
    if (auto* m = std::get_if<DiffuseDescription>(&material.material)) return &m->colour;
    if (auto* m = std::get_if<ConductorDescription>(&material.material)) return &m->colour;
    if (auto* m = std::get_if<EmissiveDescription>(&material.material)) return &m->radiance;
    if (auto* m = std::get_if<MixDescription>(&material.material)) return &m->weight;
    return nullptr;
}

}  // namespace

std::vector<std::filesystem::path*> sceneFiles(SceneDescription& scene) {
    std::vector<std::filesystem::path*> files;
    const auto add = [&](std::filesystem::path& file) {
        if (!file.empty()) files.push_back(&file);
    };
    for (VolumeDescription& volume : scene.volumes) add(volume.file);
    for (LightDescription& light : scene.lights)
        if (auto* environment = std::get_if<EnvironmentDescription>(&light.light))
            add(environment->image);
    for (MaterialDescription& material : scene.materials)
        if (TextureDescription* texture = textureOf(material)) add(texture->image);
    for (SurfaceDescription& surface : scene.surfaces) {
        if (auto* mesh = std::get_if<MeshShape>(&surface.shape)) add(mesh->file);
        add(surface.instanceFile);
    }
    return files;
}

}  // namespace woodcock::scene
