// SPDX-License-Identifier: Apache-2.0
#include "tools/common/picture_facts.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

#include "woodcock/scene/build.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::tool {

namespace {

constexpr const char* yes = "yes";
constexpr const char* no = "no";
constexpr const char* cameraFact = "worldToCamera";
constexpr const char* ndcFact = "worldToNDC";
constexpr const char* rateFact = "framesPerSecond";
constexpr const char* shutterFact = "shutter";

/// What the headers of EXR files say of the shot.
image::StateFacts shotFacts(const scene::SceneDescription& scene) {
    image::RenderMetadata shot;
    scene::describeShot(scene, shot);
    image::StateFacts facts{{shutterFact, fmt::format("{}", shot.shutter)}};
    if (shot.worldToCamera)
        facts[cameraFact] = fmt::format("{}", fmt::join(*shot.worldToCamera, ","));
    if (shot.worldToNdc) facts[ndcFact] = fmt::format("{}", fmt::join(*shot.worldToNdc, ","));
    if (const auto& rate = shot.framesPerSecond)
        facts[rateFact] = fmt::format("{},{}", rate->numerator, rate->denominator);
    return facts;
}

image::RenderMetadata shotOf(const image::StateFile& file) {
    image::RenderMetadata shot;
    const auto matrix = [&](const char* fact, std::optional<image::Matrix44>& to) {
        if (!file.has(fact)) return;
        const std::vector<float> numbers = file.numbers<float>(fact, to.emplace().size());
        std::copy(numbers.begin(), numbers.end(), to->begin());
    };
    matrix(cameraFact, shot.worldToCamera);
    matrix(ndcFact, shot.worldToNdc);
    shot.shutter = file.number(shutterFact);
    if (file.has(rateFact)) {
        const std::vector<int> rate = file.numbers<int>(rateFact, 2);
        if (rate[0] < 1 || rate[1] < 1)
            throw file.unreadable(fmt::format("its '{}' is no rate", rateFact));
        shot.framesPerSecond = {rate[0], static_cast<unsigned>(rate[1])};
    }
    return shot;
}

}  // namespace

image::StateFacts factsOf(const scene::SceneDescription& scene) {
    const scene::OutputDescription& o = scene.output;
    image::StateFacts facts{
        {"scene", scene::sceneDigest(scene)},
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
    facts.merge(shotFacts(scene));
    return facts;
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
    facts.shot = shotOf(file);
    return facts;
}

}  // namespace woodcock::tool
