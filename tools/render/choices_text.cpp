// SPDX-License-Identifier: Apache-2.0
#include "tools/render/choices_text.h"

#include <fmt/format.h>

#include "woodcock/scene/keys/sections.h"

namespace woodcock::tool {

namespace {

std::string describe(const scene::SunDescription& sun) {
    return sun.place ? fmt::format("a sun {:g} degrees high at azimuth {:g}", sun.place->elevation,
                                   sun.place->azimuth)
                     : "a sun";
}
std::string describe(const scene::EnvironmentDescription& environment) {
    return !environment.visible   ? "a fill that is not seen"
           : environment.graded() ? "a graded backdrop"
                                  : "an even sky";
}
template <class L>
std::string describe(const L&) {
    return fmt::format("a {} light", scene::keysOf<L>().tag);
}

void describeVolumes(const Openings& open, const scene::SceneDescription& complete,
                     std::vector<std::string>& parts) {
    for (std::size_t i = 0; i < complete.volumes.size(); ++i) {
        const scene::VolumeDescription& volume = complete.volumes[i];
        const auto* c = std::get_if<scene::DensityCoefficients>(&volume.coefficients);
        if (!c) continue;
        const std::string file = volume.file.filename().string();
        if (open.density[i]) parts.push_back(fmt::format("the grid '{}' of {}", c->density, file));
        if (open.scale[i] && c->scale)
            parts.push_back(fmt::format("its density scale {:g}", c->scale->mean()));
        if (open.glow[i] && volume.blackbody)
            parts.push_back(fmt::format("that its '{}' glows", volume.blackbody->temperature));
        if (open.colour[i] && !c->albedoGrid.empty())
            parts.push_back(fmt::format("that its '{}' colours it", c->albedoGrid));
    }
}

}  // namespace

Openings openingsOf(const scene::SceneDescription& scene) {
    Openings open;
    for (const scene::VolumeDescription& volume : scene.volumes) {
        const auto* c = std::get_if<scene::DensityCoefficients>(&volume.coefficients);
        open.density.push_back(c && c->density.empty());
        open.scale.push_back(c && !c->scale);
        open.glow.push_back(!volume.blackbody && !volume.emission);
        open.colour.push_back(c && c->albedoGrid.empty());
    }
    open.camera = !scene.camera.pose;
    open.lights = scene.lights.empty();
    open.exposure =
        scene.output.exposure == 0 && scene::findPlace(scene.places, "output.exposure").empty();
    return open;
}

std::string describeChoices(const Openings& open, const scene::SceneDescription& complete) {
    std::vector<std::string> parts;
    describeVolumes(open, complete, parts);
    if (open.camera) parts.push_back("a camera that frames what is there");
    if (open.lights)
        for (const scene::LightDescription& light : complete.lights)
            parts.push_back(std::visit([](const auto& l) { return describe(l); }, light.light));
    if (open.exposure && complete.output.exposure != 0)
        parts.push_back(fmt::format("an exposure of {:+g} stops", complete.output.exposure));
    if (parts.empty()) return "the scene with every value that it uses; nothing was left to choose";
    return fmt::format(
        "the scene with every value that it uses. Chosen were {}; edit them there, or change them "
        "with --set",
        fmt::join(parts, ", "));
}

}  // namespace woodcock::tool
