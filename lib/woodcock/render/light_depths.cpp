// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/light_depths.h"

#include <algorithm>

#include "woodcock/render/needs.h"

namespace woodcock::render {

namespace {

/// Memory that each sun's grid may take, and those of all lamps together: so much, or a quarter of
/// the medium's fields.
constexpr std::size_t mostBytes = 64u << 20;

std::size_t bytesOf(const medium::Medium& medium) {
    std::size_t bytes = 0;
    for (const medium::MediumPart& part : medium.parts)
        if (part.field()) bytes += part.field()->bytes();
    return bytes;
}

/// How far samples of a local light are from its position, at most: its radius.
double radiusOf(const light::LightSet& lights, int light, Vec3d position, Vec3d from) {
    constexpr int each = 4;
    double radius = 0;
    for (int i = 0; i < each; ++i)
        for (int j = 0; j < each; ++j) {
            constexpr double last = (1 - 1e-9) / (each - 1);  // both ends are its edges
            const light::LightSample s = lights.sample(light, from, i * last, j * last);
            if (s.weight.maximum() > 0)
                radius = std::max(radius, length(from + s.direction * s.distance - position));
        }
    return radius;
}

}  // namespace

LightDepths::LightDepths(const Scene& scene, const Approximations& approximations,
                         const ApproximateMedia& media)
    : lights_(scene.lights.lights().size()) {
    if (approximations.marchStep > 0) return;
    add(scene, scene.medium);
    for (const ApproximateMedia::Set& set : media.sets) add(scene, set.front());
}

std::size_t LightDepths::bytesAtMost() const {
    std::size_t bytes = 0;
    for (const auto& grid : grids_)
        if (grid) bytes += grid->bytesOfAll();
    return bytes;
}

double bytesOfLightDepths(const Scene& scene, const Approximations& approximations) {
    const ApproximateMedia media(scene, approximations);
    return static_cast<double>(LightDepths(scene, approximations, media).bytesAtMost());
}

void LightDepths::add(const Scene& scene, const medium::Medium& medium) {
    const std::size_t most = std::max(mostBytes, bytesOf(medium) / 4);
    const std::size_t ofLamp = most / std::max<std::size_t>(1, scene.lights.local().size());
    // Equiangular points count on next events of an equal share; see drawSeveralEvents().
    const bool lamps = !findNeeds(scene).localLights && !scene.lights.moves();
    for (std::size_t i = 0; i < lights_; ++i) {
        const auto light = static_cast<int>(i);
        const light::LightTraits& traits = scene.lights.traits(light);
        std::unique_ptr<const medium::DepthGrid>& grid = grids_.emplace_back();
        if (traits.parallel)
            grid = medium::DepthGrid::make(medium, *traits.parallel, most);
        else if (traits.position && lamps)
            grid = medium::DepthGrid::makeForLamp(
                medium, *traits.position,
                radiusOf(scene.lights, light, *traits.position, medium.worldBounds().centre()),
                ofLamp);
    }
}

}  // namespace woodcock::render
