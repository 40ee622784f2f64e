// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/write.h"

#include <fmt/format.h>

#include "woodcock/base/error.h"
#include "woodcock/base/path_variables.h"
#include "woodcock/base/toml_text.h"

namespace woodcock {
namespace {

const auto identity = Affine3d();

/// Lines of a scene file.
class Writer {
public:
    enum class Comments { No, Yes };
    Writer(const std::filesystem::path& directory, Comments comments)
        : directory_(directory), comments_(comments == Comments::Yes) {}

    void heading(std::string_view text) {
        text_ += fmt::format("{}{}\n", text_.empty() ? "" : "\n", text);
    }
    void line(std::string_view key, std::string_view value, std::string_view comment = "") {
        text_ += fmt::format("{} = {}", key, value);
        if (comments_ && !comment.empty()) text_ += fmt::format("  # {}", comment);
        text_ += '\n';
    }
    void path(std::string_view key, const std::filesystem::path& p) { line(key, quoted(p)); }
    void paths(std::string_view key, const std::vector<std::filesystem::path>& all) {
        std::vector<std::string> items;
        for (const auto& p : all) items.push_back(quoted(p));
        line(key, fmt::format("[{}]", fmt::join(items, ", ")));
    }
    void comment(std::string_view text) {
        if (comments_) text_ += fmt::format("# {}\n", text);
    }
    const std::string& text() const { return text_; }

private:
    std::string quoted(const std::filesystem::path& p) const {
        namespace fs = std::filesystem;
        const bool here = directory_.empty() || directory_ == ".";
        if (here || p.is_absolute()) return tomlText(escapePath(p));
        return tomlText(escapePath(fs::absolute(p).lexically_normal().lexically_proximate(
            fs::absolute(directory_ / "").lexically_normal())));
    }

    std::filesystem::path directory_;
    bool comments_;
    std::string text_;
};

void write(Writer& out, const DensityCoefficients& c) {
    const DensityCoefficients defaults;
    if (!c.density.empty()) out.line("density", tomlText(c.density));
    if (c.scale) out.line("scale", tomlColour(*c.scale), "sigma_t = scale x density, 1/unit");
    if (c.albedo != defaults.albedo) out.line("albedo", tomlColour(c.albedo));
    if (!c.albedoGrid.empty()) out.line("albedo_grid", tomlText(c.albedoGrid));
}

void write(Writer& out, std::string_view key, const std::optional<GridCoefficient>& c) {
    if (!c) return;
    if (c->grid.empty())
        out.line(key, tomlColour(c->scale), "x density, 1/unit");
    else
        out.line(key, fmt::format("{{ grid = {}, scale = {} }}", tomlText(c->grid),
                                  tomlColour(c->scale)));
}

void write(Writer& out, const SeparateCoefficients& c) {
    write(out, "sigma_a", c.sigmaA);
    write(out, "sigma_s", c.sigmaS);
}

void write(Writer& out, const HomogeneousBox& c) {
    out.line("box", fmt::format("{{ min = {}, max = {} }}", tomlVector(c.box.lower),
                                tomlVector(c.box.upper)));
    out.line("sigma_a", tomlColour(c.sigmaA), "1/unit");
    out.line("sigma_s", tomlColour(c.sigmaS), "1/unit");
}

void write(Writer& out, const VolumeDescription& volume) {
    const VolumeDescription defaults;
    out.heading("[[volume]]");
    if (!volume.file.empty()) out.path("file", volume.file);
    std::visit([&](const auto& c) { write(out, c); }, volume.coefficients);
    if (volume.g != defaults.g) out.line("g", fmt::format("{}", volume.g), "mean cosine");
    if (volume.worldFromObject != identity) out.line("matrix", tomlMatrix(volume.worldFromObject));
    if (volume.storage != defaults.storage)
        out.line("storage", volume.storage == Storage::Half ? "\"half\"" : "\"float\"");
    if (volume.repair) out.line("repair", "true");
}

void write(Writer& out, const SunDescription& sun) {
    out.line("type", "\"sun\"");
    out.line("direction", tomlVector(sun.direction), "the way its light travels");
    out.line("irradiance", tomlColour(sun.irradiance));
    if (sun.angularDiameter != 0)
        out.line("angular_diameter", tomlNumber(sun.angularDiameter), "degrees");
    if (sun.visible) out.line("visible", "true");
}

void write(Writer& out, const EnvironmentDescription& environment) {
    out.line("type", "\"environment\"");
    out.line("radiance", tomlColour(environment.radiance));
    if (!environment.image.empty()) out.path("image", environment.image);
    if (environment.rotation != 0)
        out.line("rotation", tomlNumber(environment.rotation), "degrees");
    if (environment.up == UpAxis::Z) out.line("up", "\"z\"");
    if (!environment.visible) out.line("visible", "false");
}

void write(Writer& out, const PointDescription& point) {
    out.line("type", "\"point\"");
    out.line("position", tomlVector(point.position));
    out.line("intensity", tomlColour(point.intensity));
}

void write(Writer& out, const SphereDescription& sphere) {
    out.line("type", "\"sphere\"");
    out.line("position", tomlVector(sphere.position));
    out.line("radius", tomlNumber(sphere.radius));
    out.line("radiance", tomlColour(sphere.radiance));
    if (!sphere.visible) out.line("visible", "false");
}

void write(Writer& out, const LightDescription& light) {
    out.heading("[[light]]");
    std::visit([&](const auto& kind) { write(out, kind); }, light.light);
}

void write(Writer& out, const LookAt& pose) {
    out.line("eye", tomlVector(pose.eye));
    out.line("look_at", tomlVector(pose.target));
    out.line("up", tomlVector(pose.up));
}

void write(Writer& out, const PartialPose& given) {
    if (given.eye) out.line("eye", tomlVector(*given.eye));
    if (given.target) out.line("look_at", tomlVector(*given.target));
    if (given.up) out.line("up", tomlVector(*given.up));
}

void write(Writer& out, const Affine3d& pose) {
    out.line("matrix", tomlMatrix(pose), "world from camera, which looks along -z");
}

void write(Writer& out, const CameraDescription& camera) {
    out.heading("[camera]");
    if (camera.kind == CameraDescription::Kind::Orthographic) {
        out.line("type", "\"orthographic\"");
        if (camera.height)
            out.line("height", tomlNumber(*camera.height), "world units, bottom to top");
    } else {
        out.line("fov", tomlNumber(camera.fovY), "degrees, bottom to top");
    }
    if (camera.pose)
        std::visit([&](const auto& pose) { write(out, pose); }, *camera.pose);
    else
        write(out, camera.given);
}

void write(Writer& out, const RenderDescription& render) {
    if (render.seed >> 63 != 0)
        throw usageError("the seed {} is larger than a scene file can hold (2^63 - 1)",
                         render.seed);
    out.heading("[render]");
    out.line("resolution", fmt::format("[{}, {}]", render.width, render.height));
    out.line("spp", fmt::format("{}", render.spp), "samples per pixel");
    if (render.seed != 0) out.line("seed", fmt::format("{}", render.seed));
    if (render.maxScatterings)
        out.line("max_scatterings", fmt::format("{}", *render.maxScatterings));
    if (render.timeLimit != 0) out.line("time_limit", tomlNumber(render.timeLimit), "seconds");
    if (render.noise != 0) out.line("noise", tomlNumber(render.noise));
    if (render.majorantScale != 1) out.line("majorant_scale", tomlNumber(render.majorantScale));
}

void write(Writer& out, const OutputDescription& output) {
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

void write(Writer& out, const SceneDescription& scene) {
    out.comment("A Woodcock scene. Lengths are world units, angles degrees, colours scene-linear.");
    if (!scene.ocio.empty()) out.path("ocio", scene.ocio);
    for (const VolumeDescription& volume : scene.volumes) write(out, volume);
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
    Writer out(".", Writer::Comments::Yes);
    write(out, section);
    return out.text();
}

}  // namespace

std::string writeVolume(const VolumeDescription& volume) { return writeSection(volume); }
std::string writeCamera(const CameraDescription& camera) { return writeSection(camera); }
std::string writeLight(const LightDescription& light) { return writeSection(light); }

std::string writeScene(const SceneDescription& scene, const std::filesystem::path& directory) {
    Writer out(directory, Writer::Comments::Yes);
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
    content.render.majorantScale = scene.render.majorantScale;
    const auto anchor = [](std::filesystem::path& p) {
        if (!p.empty()) p = std::filesystem::absolute(p).lexically_normal();
    };
    for (VolumeDescription& volume : content.volumes) anchor(volume.file);
    for (LightDescription& light : content.lights)
        if (auto* environment = std::get_if<EnvironmentDescription>(&light.light))
            anchor(environment->image);
    Writer out(".", Writer::Comments::No);
    write(out, content);
    return fmt::format("{:016x}", hashOf(out.text()));
}

}  // namespace woodcock
