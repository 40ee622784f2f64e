// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "woodcock/base/parse.h"
#include "woodcock/image/image_format.h"
#include "woodcock/image/write_exr.h"
#include "woodcock/scene/parse_sections.h"
#include "woodcock/scene/parse_values.h"

namespace woodcock {
namespace {

constexpr int largestCount = std::numeric_limits<int>::max();

/// What `read` makes of a value's text; its complaints gain the value's place.
template <class Read>
auto readText(const TomlValue& value, Read read) {
    const std::string text = value.text();
    try {
        return read(text);
    } catch (const Error& e) {
        throw inputError("{}: {}: {}", value.place(), value.name(), e.what());
    }
}

std::vector<std::string> parseLayers(const TomlValue& value) {
    const std::vector<std::string> known = layerNames();
    std::vector<std::string> layers;
    for (const TomlValue& element : value.elements("a list of layers, such as [\"depth\"]")) {
        const std::string& layer = known[element.choice("layer", known)];
        if (std::find(layers.begin(), layers.end(), layer) != layers.end())
            throw element.error("repeats the layer '{}'", layer);
        layers.push_back(layer);
    }
    return layers;
}

std::filesystem::path parseOutputFile(const TomlValue& value, const std::filesystem::path& base) {
    readText(value, [](const std::string& text) { return imageFormat(text); });
    return value.path(base);
}

Approximations parseApproximations(const TomlTable& table) {
    Approximations a;
    if (const auto v = table.find("transparent_shadows")) a.transparentShadows = v->flag();
    if (const auto v = table.find("march_step")) a.marchStep = v->number({0, 1000});
    if (const auto v = table.find("march_estimate")) {
        if (!(a.marchStep > 0)) throw v->error("needs march_step: tracking takes no steps");
        a.jackknife =
            v->choice("estimate", std::array<std::string, 2>{"jackknife", "exponential"}) == 0;
    }
    if (const auto v = table.find("similarity_after"))
        a.similarityAfter = v->integer(0, largestCount);
    if (const auto v = table.find("octaves")) {
        a.octaves = v->integer(0, 16);
        if (a.octaves > 0 && a.similarityAfter)
            throw v->error("contradicts similarity_after: octaves have no paths that go on");
    }
    if (const auto v = table.find("clamp")) a.clamp = v->number(notNegative);
    return a;
}

}  // namespace

RenderDescription parseRender(const TomlTable& table) {
    table.allowOnly(
        {"resolution", "spp", "seed", "quality", "max_scatterings", "max_bounces", "transparent_shadows",
         "march_step", "march_estimate", "similarity_after", "octaves", "clamp", "storage",
         "lookup", "level_of_detail", "adaptive", "time_limit", "noise", "majorant_scale"},
        "[render]");
    RenderDescription render;
    if (const auto v = table.find("resolution")) {
        const auto sides = v->elements("[width, height]", 2);
        render.width = sides[0].integer(1, largestImageSide);
        render.height = sides[1].integer(1, largestImageSide);
    }
    if (const auto v = table.find("spp")) render.spp = v->integer(1, largestCount);
    if (const auto v = table.find("seed")) render.seed = v->count();
    if (const auto v = table.find("max_scatterings"))
        render.maxScatterings = v->integer(0, largestCount);
    if (const auto v = table.find("max_bounces")) render.maxBounces = v->integer(0, largestCount);
    render.approximations = parseApproximations(table);
    if (const auto v = table.find("storage")) render.storage = parseStorage(*v);
    if (const auto v = table.find("lookup"))
        render.lookup = std::array{Lookup::Trilinear, Lookup::Nearest}[v->choice(
            "lookup", std::array<std::string, 2>{"trilinear", "nearest"})];
    if (const auto v = table.find("level_of_detail")) render.levelOfDetail = v->number({0, 1000});
    if (const auto v = table.find("adaptive")) render.adaptive = v->flag();
    if (const auto v = table.find("time_limit"))
        render.timeLimit = v->isText() ? readText(*v, parseDuration) : v->number(notNegative);
    if (const auto v = table.find("noise"))
        render.noise = v->isText() ? readText(*v, parseFraction) : v->number({0, 1});
    if (const auto v = table.find("majorant_scale")) render.majorantScale = v->number({1, 1000});
    return render;
}

OutputDescription parseOutput(const TomlTable& table, const std::filesystem::path& base) {
    table.allowOnly({"files", "layers", "half", "display", "view", "look", "exposure"}, "[output]");
    OutputDescription output;
    if (const auto v = table.find("files"))
        for (const TomlValue& file : v->elements("a list of files, such as [\"smoke.exr\"]"))
            output.files.push_back(parseOutputFile(file, base));
    if (const auto v = table.find("layers")) output.layers = parseLayers(*v);
    if (const auto v = table.find("half")) output.half = v->flag();
    if (const auto v = table.find("display")) output.display = v->text();
    if (const auto v = table.find("view")) output.view = v->text();
    if (const auto v = table.find("look")) output.look = v->text();
    if (const auto v = table.find("exposure")) output.exposure = v->number({-100, 100});
    return output;
}

}  // namespace woodcock
