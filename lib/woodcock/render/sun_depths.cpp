// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/sun_depths.h"

#include <algorithm>

namespace woodcock::render {

namespace {

/// Memory that each grid may take: so much, or a quarter of the medium's fields.
constexpr std::size_t mostBytes = 64u << 20;

std::size_t bytesOf(const medium::Medium& medium) {
    std::size_t bytes = 0;
    for (const medium::MediumPart& part : medium.parts)
        if (part.field()) bytes += part.field()->bytes();
    return bytes;
}

}  // namespace

SunDepths::SunDepths(const Scene& scene, const Approximations& approximations,
                     const ApproximateMedia& media)
    : lights_(scene.lights.lights().size()) {
    if (approximations.marchStep > 0) return;
    add(scene, scene.medium);
    for (const ApproximateMedia::Set& set : media.sets) add(scene, set.front());
}

std::size_t SunDepths::bytesAtMost() const {
    std::size_t bytes = 0;
    for (const auto& grid : grids_)
        if (grid) bytes += grid->bytesOfAll();
    return bytes;
}

double bytesOfSunDepths(const Scene& scene, const Approximations& approximations) {
    const ApproximateMedia media(scene, approximations);
    return static_cast<double>(SunDepths(scene, approximations, media).bytesAtMost());
}

void SunDepths::add(const Scene& scene, const medium::Medium& medium) {
    const std::size_t most = std::max(mostBytes, bytesOf(medium) / 4);
    for (std::size_t i = 0; i < lights_; ++i) {
        const auto towards = scene.lights.traits(static_cast<int>(i)).parallel;
        grids_.push_back(towards ? medium::DepthGrid::make(medium, *towards, most) : nullptr);
    }
}

}  // namespace woodcock::render
