// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/write.h"

#include <fmt/format.h>

#include "woodcock/scene/keys/sections.h"

namespace woodcock::scene {
namespace {

void write(SceneWriter& out, const VolumeDescription& volume) {
    out.heading("[[volume]]");
    writeKeys(out, volume);
}

void write(SceneWriter& out, const MaterialDescription& material) {
    out.heading("[[material]]");
    writeKeys(out, material);
    writeTagged(out, material.material);
}

void write(SceneWriter& out, const SurfaceDescription& surface) {
    out.heading("[[surface]]");
    writeKeys(out, surface);
}

void write(SceneWriter& out, const LightDescription& light) {
    out.heading("[[light]]");
    writeTagged(out, light.light);
}

void write(SceneWriter& out, const CameraDescription& camera) {
    out.heading("[camera]");
    writeKeys(out, camera);
}

void write(SceneWriter& out, const SceneDescription& scene) {
    out.comment("A Woodcock scene. Lengths are world units, angles degrees, colours scene-linear.");
    writeKeys(out, scene);
    for (const VolumeDescription& volume : scene.volumes) write(out, volume);
    for (const MaterialDescription& material : scene.materials) write(out, material);
    for (const SurfaceDescription& surface : scene.surfaces) write(out, surface);
    for (const LightDescription& light : scene.lights) write(out, light);
    if (scene.camera != CameraDescription()) write(out, scene.camera);
    out.heading("[render]");
    writeKeys(out, scene.render);
    if (out.isDigest() || scene.output == OutputDescription()) return;
    out.heading("[output]");
    writeKeys(out, scene.output);
}

/// FNV-1a, 64 bits.
std::uint64_t hashOf(std::string_view text) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char c : text) {
        hash ^= static_cast<unsigned char>(c);
        hash *= 0x100000001b3;
    }
    return hash;
}

template <class Section>
std::string writeSection(const Section& section) {
    SceneWriter out(".", SceneWriter::Mode::File);
    write(out, section);
    return out.text();
}

}  // namespace

std::string writeVolume(const VolumeDescription& volume) { return writeSection(volume); }
std::string writeCamera(const CameraDescription& camera) { return writeSection(camera); }
std::string writeLight(const LightDescription& light) { return writeSection(light); }

std::string writeScene(const SceneDescription& scene, const std::filesystem::path& directory) {
    SceneWriter out(directory, SceneWriter::Mode::File);
    write(out, scene);
    return out.text();
}

std::string sceneDigest(const SceneDescription& scene) {
    SceneDescription content = scene;
    // However it is said where a sun stands.
    for (LightDescription& light : content.lights)
        if (auto* sun = std::get_if<SunDescription>(&light.light)) sun->place.reset();
    SceneWriter out(".", SceneWriter::Mode::Digest);
    write(out, content);
    return fmt::format("{:016x}", hashOf(out.text()));
}

}  // namespace woodcock::scene
