// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/write_surfaces.h"

#include "woodcock/scene/check_surfaces.h"

namespace woodcock {
namespace {

void write(SceneWriter& out, std::string_view key, const TextureDescription& texture) {
    if (texture.image.empty()) return out.line(key, tomlColour(texture.colour));
    std::string value = "{ image = " + out.quoted(texture.image);
    if (!texture.colourSpace.empty()) value += ", colour_space = " + tomlText(texture.colourSpace);
    if (texture.colour != Rgb(1)) value += ", times = " + tomlColour(texture.colour);
    out.line(key, value + " }");
}

void write(SceneWriter& out, const DiffuseDescription& m) { write(out, "colour", m.colour); }
void write(SceneWriter& out, const ConductorDescription& m) {
    if (m.etaK) {
        out.line("eta", tomlColour(m.etaK->first));
        out.line("k", tomlColour(m.etaK->second));
    } else {
        write(out, "colour", m.colour);
    }
    if (m.roughness != 0) out.line("roughness", tomlNumber(m.roughness));
}
void write(SceneWriter& out, const DielectricDescription& m) {
    out.line("ior", tomlNumber(m.ior));
    if (m.ior < 1) out.line("ior_below_one", "true");
    if (m.roughness != 0) out.line("roughness", tomlNumber(m.roughness));
}
void write(SceneWriter&, const InterfaceDescription&) {}
void write(SceneWriter& out, const EmissiveDescription& m) {
    write(out, "radiance", m.radiance);
    if (m.bothSides) out.line("both_sides", "true");
}
void write(SceneWriter& out, const MixDescription& m) {
    out.line("first", tomlText(m.first));
    out.line("second", tomlText(m.second));
    write(out, "weight", m.weight);
}

void write(SceneWriter& out, const MeshShape& shape) {
    out.path("file", shape.file);
    if (!shape.levelSet.empty()) out.line("level_set", tomlText(shape.levelSet));
}
void write(SceneWriter& out, const SphereShape& shape) {
    out.line("sphere", fmt::format("{{ centre = {}, radius = {} }}", tomlVector(shape.centre),
                                   tomlNumber(shape.radius)));
}
void write(SceneWriter& out, const BoxShape& shape) {
    out.line("box", fmt::format("{{ min = {}, max = {} }}", tomlVector(shape.box.lower),
                                tomlVector(shape.box.upper)));
}
void write(SceneWriter& out, const DiskShape& shape) {
    out.line("disk", fmt::format("{{ radius = {} }}", tomlNumber(shape.radius)));
}
void write(SceneWriter& out, const PlaneShape& shape) {
    out.line("plane", !shape.size
                          ? "{}"
                          : fmt::format("{{ size = [{}, {}] }}", tomlNumber((*shape.size)[0]),
                                        tomlNumber((*shape.size)[1])));
}
void write(SceneWriter& out, const LatheShape& shape) {
    std::vector<std::string> points;
    for (const auto& [radius, height] : shape.profile)
        points.push_back(fmt::format("[{}, {}]", tomlNumber(radius), tomlNumber(height)));
    out.line("lathe", fmt::format("{{ profile = [{}], segments = {} }}", fmt::join(points, ", "),
                                  shape.segments));
}

void write(SceneWriter& out, const FacetShape& shape) {
    std::string all = "[";
    for (const FacetRing& r : shape.rings)
        all +=
            fmt::format("\n    {{ angle = {}, count = {}, distance = {}, turn = {} }},",
                        tomlNumber(r.angle), r.count, tomlNumber(r.distance), tomlNumber(r.turn));
    out.line("facets", all + "\n]");
}

void write(SceneWriter& out, const InteriorDescription& interior) {
    std::string value = fmt::format("{{ sigma_a = {}, sigma_s = {}", tomlColour(interior.sigmaA),
                                    tomlColour(interior.sigmaS));
    if (interior.g != 0) value += fmt::format(", g = {}", interior.g);
    if (interior.emission != Rgb(0)) value += ", emission = " + tomlColour(interior.emission);
    out.line("medium", value + " }", "1/unit");
}

void writeInstances(SceneWriter& out, const SurfaceDescription& surface) {
    if (!surface.instanceFile.empty()) return out.path("instances", surface.instanceFile);
    if (surface.instances.empty()) return;
    std::string all = "[";
    for (const Affine3d& instance : surface.instances) all += "\n    " + tomlMatrix(instance) + ",";
    out.line("instances", all + "\n]");
}

}  // namespace

void writeMaterial(SceneWriter& out, const MaterialDescription& material) {
    out.heading("[[material]]");
    out.line("name", tomlText(material.name));
    out.line("type", fmt::format("\"{}\"", typeName(material)));
    std::visit([&](const auto& m) { write(out, m); }, material.material);
}

void writeSurface(SceneWriter& out, const SurfaceDescription& surface) {
    out.heading("[[surface]]");
    if (!surface.name.empty()) out.line("name", tomlText(surface.name));
    std::visit([&](const auto& shape) { write(out, shape); }, surface.shape);
    if (!surface.material.empty()) out.line("material", tomlText(surface.material));
    if (surface.smooth)
        out.line("smooth", *surface.smooth == 0 ? "\"flat\"" : tomlNumber(*surface.smooth));
    if (surface.worldFromObject != Affine3d())
        out.line("matrix", tomlMatrix(surface.worldFromObject));
    writeInstances(out, surface);
    if (surface.interior) write(out, *surface.interior);
    if (surface.priority != 0) out.line("priority", fmt::format("{}", surface.priority));
    if (surface.holdout) out.line("holdout", "true");
    if (surface.shadowCatcher) out.line("shadow_catcher", "true");
    if (surface.matte) out.line("matte", "true");
    if (!surface.cameraVisible) out.line("camera_visible", "false");
}

}  // namespace woodcock
