// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "woodcock/scene/build.h"
#include "woodcock/scene/quality.h"
#include "woodcock/trade/candidates.h"

namespace woodcock::trade {
namespace {

void add(std::vector<Candidate>& list, const std::string& name, const std::string& choice) {
    list.push_back({name, "", {choice}});
}

/// To one digit.
double roughly(double v) {
    const double power = std::pow(10, std::floor(std::log10(v)));
    return std::round(v / power) * power;
}

/// All strengths, or the one in the middle.
std::vector<int> strengths(Extent extent, std::vector<int> all) {
    return extent == Extent::All ? all : std::vector{all[all.size() / 2]};
}

void addMarching(std::vector<Candidate>& list, Extent extent) {
    for (const int voxels : strengths(extent, {1, 2, 4}))
        add(list, fmt::format("march step {}", voxels),
            fmt::format("render.march_step={}", voxels));
    if (extent == Extent::All)
        list.push_back({"march step 1, exponential",
                        "",
                        {"render.march_step=1", "render.march_estimate=exponential"}});
}

void addFieldChoices(std::vector<Candidate>& list, const SceneFacts& facts, Extent extent) {
    for (std::size_t i = 0; extent == Extent::All && i < grid::storageNames.size(); ++i) {
        const auto storage = static_cast<grid::Storage>(i);
        if (storage != grid::Storage::Auto && storage != grid::Storage::Float)
            add(list, "storage " + grid::storageNames[i],
                fmt::format("render.storage={}", grid::storageNames[i]));
    }
    if (extent == Extent::All) add(list, "nearest lookup", "render.lookup=nearest");
    if (facts.cameraInside) return;  // no level of detail would be coarser around the camera
    for (const int pixels : strengths(extent, {1, 2, 4}))
        add(list, fmt::format("level of detail {}", pixels),
            fmt::format("render.level_of_detail={}", pixels));
}

void addScatteringChoices(std::vector<Candidate>& list, const SceneFacts& facts, Extent extent) {
    for (const int order : strengths(extent, {1, 4, 16}))
        if (order < facts.mostScatterings)
            add(list, fmt::format("{} scattering{}", order, order > 1 ? "s" : ""),
                fmt::format("render.max_scatterings={}", order));
    if (facts.largestG > 0)
        for (const int order : strengths(extent, {1, 4, 16}))
            add(list, fmt::format("similarity after {}", order),
                fmt::format("render.similarity_after={}", order));
    for (const int octaves : strengths(extent, {4, 8}))
        add(list, fmt::format("{} octaves", octaves), fmt::format("render.octaves={}", octaves));
}

void addClamps(std::vector<Candidate>& list, const SceneFacts& facts, Extent extent) {
    if (!(facts.meanRadiance > 0)) return;
    for (const int times : strengths(extent, {100, 10, 3})) {
        const double limit = roughly(times * facts.meanRadiance);
        add(list, fmt::format("clamp {:g}", limit), fmt::format("render.clamp={:g}", limit));
    }
}

}  // namespace

SceneFacts sceneFacts(const scene::SceneDescription& description, const render::Scene& scene) {
    SceneFacts facts;
    std::vector<const medium::Medium*> media{&scene.medium};
    for (const medium::Medium& medium : scene.interiorMedia) media.push_back(&medium);
    for (const medium::Medium* medium : media)
        for (const medium::MediumPart& part : medium->parts) {
            facts.grids |= part.field() != nullptr;
            facts.scattering |= part.scatters();
            if (part.scatters())
                facts.largestG = std::max(facts.largestG, std::abs(part.phase().meanCosine()));
        }
    facts.mostScatterings =
        description.render.maxScatterings.value_or(std::numeric_limits<int>::max());
    for (const scene::MaterialDescription& material : description.materials)
        facts.dielectrics |=
            std::holds_alternative<scene::DielectricDescription>(material.material);
    if (!scene.medium.parts.empty() && description.camera.pose)
        facts.cameraInside = scene.medium.worldBounds().contains(
            scene::worldFromCamera(*description.camera.pose).point({0, 0, 0}));
    return facts;
}

std::vector<Candidate> builtInCandidates(const SceneFacts& facts, Extent extent) {
    std::vector<Candidate> list{{"as the scene says", "", {}}};
    for (const std::string& quality : scene::qualityNames) list.push_back({quality, quality, {}});
    add(list, "adaptive", "render.adaptive=true");
    if (facts.denoiser) add(list, "denoised", "render.denoise=true");
    if (facts.grids) addMarching(list, extent);
    if (facts.scattering) addScatteringChoices(list, facts, extent);
    if (facts.grids) addFieldChoices(list, facts, extent);
    addClamps(list, facts, extent);
    if (facts.dielectrics) add(list, "transparent shadows", "render.transparent_shadows=true");
    return list;
}

}  // namespace woodcock::trade
