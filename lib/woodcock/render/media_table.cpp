// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/media_table.h"

#include "woodcock/medium/octaves.h"

namespace woodcock::render {

namespace {

/// Whether a flight can meet light, so that following it finds what next-event estimation does not.
bool flightsMeetLight(const Scene& scene, const Needs& needs) {
    return needs.surfaces || needs.emission || !scene.lights.distant().empty();
}

}  // namespace

double depthAcross(const MediumSummary& medium) {
    if (medium.medium->parts.empty()) return 0;
    return medium.meanExtinction * length(medium.bounds.size());
}

bool isThick(const MediumSummary& medium) {
    constexpr double thick = 30;
    return depthAcross(medium) > thick;
}

bool thickAndPeaked(const MediumSummary& medium) {
    constexpr double peaked = 8;
    if (!isThick(medium)) return false;
    // How much the density of a sampled direction varies: its mean over that of isotropic light.
    const medium::PhaseFunction& phase = medium.medium->parts.front().phase();
    constexpr int points = 64;
    double mean = 0;
    for (int i = 0; i < points; ++i)
        mean += phase.sample({0, 0, 1}, (i + 0.5) / points, 0.5).pdf / points;
    return 4 * pi * mean > peaked;
}

MediaTable::MediaTable(const Scene& scene, const Needs& needs, const Approximations& approximations,
                       const ApproximateMedia* approximate)
    : similarityAfter_(approximations.similarityAfter), octaves_(approximations.octaves) {
    std::vector<const medium::Medium*> own{&scene.medium};
    if (needs.surfaces)
        for (const medium::Medium& medium : scene.interiorMedia) own.push_back(&medium);
    setSize_ = static_cast<std::uint32_t>(own.size());
    for (const medium::Medium* medium : own) media_.emplace_back(*medium);
    replaces_ = approximate && !approximate->sets.empty();
    if (!replaces_) return;
    for (const ApproximateMedia::Set& set : approximate->sets)
        for (std::size_t i = 0; i < own.size(); ++i) media_.emplace_back(set[i], *own[i]);
    octavesEnd_ = octaves_ > 0 && !flightsMeetLight(scene, needs);
}

MediaTable::Onward MediaTable::onward(std::int64_t scatterings, RandomStream& random) const {
    if (octaves_ == 0) return {setAfter(scatterings + 1)};
    const int i = medium::octave::draw(octaves_, random.uniform());
    return {static_cast<std::uint8_t>(1 + i), medium::octave::total(octaves_)};
}

}  // namespace woodcock::render
