// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/write.h"

#include <fmt/format.h>

#include "woodcock/base/error.h"
#include "woodcock/base/toml_text.h"
#include "woodcock/scene/scene_files.h"
#include "woodcock/scene/write_surfaces.h"

namespace woodcock {
namespace {

const auto identity = Affine3d();

void write(SceneWriter& out, const DensityCoefficients& c) {
    const DensityCoefficients defaults;
    if (!c.density.empty()) out.line("density", tomlText(c.density));
    if (c.scale) out.line("scale", tomlColour(*c.scale), "sigma_t = scale x density, 1/unit");
    if (c.albedo != defaults.albedo) out.line("albedo", tomlColour(c.albedo));
    if (!c.albedoGrid.empty()) out.line("albedo_grid", tomlText(c.albedoGrid));
}

void write(SceneWriter& out, std::string_view key, const std::optional<GridCoefficient>& c,
           std::string_view comment = "x density, 1/unit") {
    if (!c) return;
    if (c->grid.empty())
        out.line(key, tomlColour(c->scale), comment);
    else
        out.line(key, fmt::format("{{ grid = {}, scale = {} }}", tomlText(c->grid),
                                  tomlColour(c->scale)));
}

void write(SceneWriter& out, const SeparateCoefficients& c) {
    write(out, "sigma_a", c.sigmaA);
    write(out, "sigma_s", c.sigmaS);
    if (!c.sigmaA && !c.sigmaS) out.line("sigma_a", "0", "it only emits");
}

void write(SceneWriter& out, const HomogeneousBox& c) {
    out.line("box", fmt::format("{{ min = {}, max = {} }}", tomlVector(c.box.lower),
                                tomlVector(c.box.upper)));
    out.line("sigma_a", tomlColour(c.sigmaA), "1/unit");
    out.line("sigma_s", tomlColour(c.sigmaS), "1/unit");
}

void write(SceneWriter& out, const BlackbodyDescription& b) {
    std::string temperature;
    if (!b.temperature.empty())
        temperature = fmt::format("temperature = {}, ", tomlText(b.temperature));
    out.line("blackbody",
             fmt::format("{{ {}scale = {}, offset = {}, intensity = {}, colour = {} }}",
                         temperature, tomlNumber(b.scale), tomlNumber(b.offset),
                         tomlNumber(b.intensity), tomlColour(b.colour)),
             "scale and offset make kelvins");
}

void write(SceneWriter& out, const VolumeDescription& volume) {
    const VolumeDescription defaults;
    out.heading("[[volume]]");
    if (!volume.file.empty()) out.path("file", volume.file);
    std::visit([&](const auto& c) { write(out, c); }, volume.coefficients);
    write(out, "emission", volume.emission,
          volume.file.empty() ? "radiance per unit" : "x density, radiance per unit");
    if (volume.blackbody) write(out, *volume.blackbody);
    if (volume.g != defaults.g) out.line("g", fmt::format("{}", volume.g), "mean cosine");
    if (volume.worldFromObject != identity) out.line("matrix", tomlMatrix(volume.worldFromObject));
    if (!volume.inside.empty()) out.line("inside", tomlText(volume.inside));
    if (volume.storage != defaults.storage)
        out.line("storage", tomlText(storageName(volume.storage)));
    if (volume.background)
        out.line("background", tomlText(backgroundNames[static_cast<size_t>(*volume.background)]));
    if (volume.repair) out.line("repair", "true");
}

void write(SceneWriter& out, const SunDescription& sun) {
    out.line("type", "\"sun\"");
    if (sun.place) {
        out.line("elevation", tomlNumber(sun.place->elevation), "degrees above the horizon");
        out.line("azimuth", tomlNumber(sun.place->azimuth), "degrees, clockwise from above");
        if (sun.place->up == UpAxis::Z) out.line("up", "\"z\"");
    } else {
        out.line("direction", tomlVector(sun.direction), "the way its light travels");
    }
    out.line("irradiance", tomlColour(sun.irradiance));
    if (sun.angularDiameter != 0)
        out.line("angular_diameter", tomlNumber(sun.angularDiameter), "degrees");
    if (sun.visible) out.line("visible", "true");
}

void write(SceneWriter& out, const EnvironmentDescription& environment) {
    out.line("type", "\"environment\"");
    out.line("radiance", tomlColour(environment.radiance));
    if (!environment.image.empty()) out.path("image", environment.image);
    if (environment.rotation != 0)
        out.line("rotation", tomlNumber(environment.rotation), "degrees");
    if (environment.up == UpAxis::Z) out.line("up", "\"z\"");
    if (!environment.visible) out.line("visible", "false");
}

void write(SceneWriter& out, const PointDescription& point) {
    out.line("type", "\"point\"");
    out.line("position", tomlVector(point.position));
    out.line("intensity", tomlColour(point.intensity));
}

void write(SceneWriter& out, const SphereDescription& sphere) {
    out.line("type", "\"sphere\"");
    out.line("position", tomlVector(sphere.position));
    out.line("radius", tomlNumber(sphere.radius));
    out.line("radiance", tomlColour(sphere.radiance));
    if (!sphere.visible) out.line("visible", "false");
}

void write(SceneWriter& out, const LightDescription& light) {
    out.heading("[[light]]");
    std::visit([&](const auto& kind) { write(out, kind); }, light.light);
}

void write(SceneWriter& out, const LookAt& pose) {
    out.line("eye", tomlVector(pose.eye));
    out.line("look_at", tomlVector(pose.target));
    out.line("up", tomlVector(pose.up));
}

void write(SceneWriter& out, const PartialPose& given) {
    if (given.eye) out.line("eye", tomlVector(*given.eye));
    if (given.target) out.line("look_at", tomlVector(*given.target));
    if (given.up) out.line("up", tomlVector(*given.up));
}

void write(SceneWriter& out, const Affine3d& pose) {
    out.line("matrix", tomlMatrix(pose), "world from camera, which looks along -z");
}

void write(SceneWriter& out, const CameraDescription& camera) {
    out.heading("[camera]");
    if (camera.kind == CameraDescription::Kind::Orthographic) {
        out.line("type", "\"orthographic\"");
        if (camera.height)
            out.line("height", tomlNumber(*camera.height), "world units, bottom to top");
    } else {
        out.line("fov", tomlNumber(camera.fovY), "degrees, bottom to top");
    }
    if (camera.shift != std::array<double, 2>{})
        out.line("shift",
                 fmt::format("[{}, {}]", tomlNumber(camera.shift[0]), tomlNumber(camera.shift[1])),
                 "of the film, in heights of the picture: right, up");
    if (camera.orbit)
        out.line("orbit", tomlNumber(*camera.orbit), "degrees to its right, around what it sees");
    if (camera.pose)
        std::visit([&](const auto& pose) { write(out, pose); }, *camera.pose);
    else
        write(out, camera.given);
}

void write(SceneWriter& out, const RenderDescription& render) {
    if (render.seed >> 63 != 0)
        throw usageError("the seed {} is larger than a scene file can hold (2^63 - 1)",
                         render.seed);
    out.heading("[render]");
    out.line("resolution", fmt::format("[{}, {}]", render.width, render.height));
    out.line("spp", fmt::format("{}", render.spp), "samples per pixel");
    if (render.seed != 0) out.line("seed", fmt::format("{}", render.seed));
    if (render.maxScatterings)
        out.line("max_scatterings", fmt::format("{}", *render.maxScatterings));
    if (render.maxBounces) out.line("max_bounces", fmt::format("{}", *render.maxBounces));
    const Approximations& a = render.approximations;
    if (a.transparentShadows) out.line("transparent_shadows", "true");
    if (a.marchStep != 0) {
        out.line("march_step", tomlNumber(a.marchStep), "voxels");
        if (!a.jackknife) out.line("march_estimate", "\"exponential\"");
    }
    if (a.similarityAfter) out.line("similarity_after", fmt::format("{}", *a.similarityAfter));
    if (a.octaves != 0) out.line("octaves", fmt::format("{}", a.octaves));
    if (a.clamp != 0) out.line("clamp", tomlNumber(a.clamp));
    if (render.storage != Storage::Auto) out.line("storage", tomlText(storageName(render.storage)));
    if (render.lookup == Lookup::Nearest) out.line("lookup", "\"nearest\"");
    if (render.levelOfDetail != 0)
        out.line("level_of_detail", tomlNumber(render.levelOfDetail), "pixels");
    if (render.adaptive) out.line("adaptive", *render.adaptive ? "true" : "false");
    if (render.timeLimit != 0) out.line("time_limit", tomlNumber(render.timeLimit), "seconds");
    if (render.noise != 0) out.line("noise", tomlNumber(render.noise));
    if (render.majorantScale != 1) out.line("majorant_scale", tomlNumber(render.majorantScale));
}

void write(SceneWriter& out, const OutputDescription& output) {
    if (output == OutputDescription()) return;
    out.heading("[output]");
    if (!output.files.empty()) out.paths("files", output.files);
    if (!output.layers.empty()) {
        std::vector<std::string> layers;
        for (const std::string& layer : output.layers) layers.push_back(tomlText(layer));
        out.line("layers", fmt::format("[{}]", fmt::join(layers, ", ")));
    }
    if (output.half) out.line("half", "true");
    if (!output.display.empty()) out.line("display", tomlText(output.display));
    if (!output.view.empty()) out.line("view", tomlText(output.view));
    if (!output.look.empty()) out.line("look", tomlText(output.look));
    if (output.exposure != 0) out.line("exposure", tomlNumber(output.exposure), "stops");
}

void write(SceneWriter& out, const SceneDescription& scene) {
    out.comment("A Woodcock scene. Lengths are world units, angles degrees, colours scene-linear.");
    if (!scene.ocio.empty()) out.path("ocio", scene.ocio);
    for (const VolumeDescription& volume : scene.volumes) write(out, volume);
    for (const MaterialDescription& material : scene.materials) writeMaterial(out, material);
    for (const SurfaceDescription& surface : scene.surfaces) writeSurface(out, surface);
    for (const LightDescription& light : scene.lights) write(out, light);
    if (scene.camera != CameraDescription()) write(out, scene.camera);
    write(out, scene.render);
    write(out, scene.output);
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
    SceneWriter out(".", SceneWriter::Comments::Yes);
    write(out, section);
    return out.text();
}

}  // namespace

std::string writeVolume(const VolumeDescription& volume) { return writeSection(volume); }
std::string writeCamera(const CameraDescription& camera) { return writeSection(camera); }
std::string writeLight(const LightDescription& light) { return writeSection(light); }

std::string writeScene(const SceneDescription& scene, const std::filesystem::path& directory) {
    SceneWriter out(directory, SceneWriter::Comments::Yes);
    write(out, scene);
    return out.text();
}

std::string sceneDigest(const SceneDescription& scene) {
    SceneDescription content = scene;
    content.output = {};
    content.ocio.clear();
    content.render = {};
    content.render.width = scene.render.width;
    content.render.height = scene.render.height;
    content.render.maxScatterings = scene.render.maxScatterings;
    content.render.maxBounces = scene.render.maxBounces;
    content.render.approximations = scene.render.approximations;
    content.render.storage = scene.render.storage;
    content.render.lookup = scene.render.lookup;
    content.render.levelOfDetail = scene.render.levelOfDetail;
    content.render.majorantScale = scene.render.majorantScale;
    // However it is said where a sun stands.
    for (LightDescription& light : content.lights)
        if (auto* sun = std::get_if<SunDescription>(&light.light)) sun->place.reset();
    for (std::filesystem::path* file : sceneFiles(content))
        *file = std::filesystem::absolute(*file).lexically_normal();
    SceneWriter out(".", SceneWriter::Comments::No);
    write(out, content);
    return fmt::format("{:016x}", hashOf(out.text()));
}

}  // namespace woodcock
