// SPDX-License-Identifier: Apache-2.0
#include "tools/common/picture_facts.h"

#include <fmt/ranges.h>

#include <sstream>

#include "woodcock/scene/build.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::tool {

namespace {

constexpr const char* yes = "yes";
constexpr const char* no = "no";

}  // namespace

image::StateFacts factsOf(const scene::SceneDescription& scene) {
    const scene::OutputDescription& o = scene.output;
    return {{"scene", scene::sceneDigest(scene)},
            {"files", scene::filesDigest(scene)},
            {"layers", fmt::format("{}", fmt::join(o.layers, ","))},
            {"half", o.half ? yes : no},
            {"multipart", o.multipart ? yes : no},
            {"display", o.display},
            {"view", o.view},
            {"look", o.look},
            {"exposure", fmt::format("{}", o.exposure)},
            {"ocio", scene.ocio.empty() ? "" : std::filesystem::absolute(scene.ocio).string()},
            {"alpha", scene::environmentIsHidden(scene) ? yes : no},
            {"glows", scene::anythingGlows(scene) ? yes : no}};
}

PictureFacts pictureFactsOf(const image::StateFile& file) {
    PictureFacts facts;
    std::istringstream layers(file.fact("layers"));
    for (std::string layer; std::getline(layers, layer, ',');) facts.output.layers.push_back(layer);
    facts.output.half = file.fact("half") == yes;
    facts.output.multipart = file.fact("multipart") == yes;
    facts.output.display = file.fact("display");
    facts.output.view = file.fact("view");
    facts.output.look = file.fact("look");
    facts.output.exposure = file.number("exposure");
    facts.ocio = file.fact("ocio");
    facts.withAlpha = file.fact("alpha") == yes;
    facts.glows = file.fact("glows") == yes;
    return facts;
}

}  // namespace woodcock::tool
