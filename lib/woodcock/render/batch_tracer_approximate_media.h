// SPDX-License-Identifier: Apache-2.0
#pragma once

// Biased choices of batch_tracer.h that concern media: similarity and octaves.

#include "woodcock/medium/octaves.h"
#include "woodcock/render/batch_tracer.h"

namespace woodcock::render {

template <int N, bool Surfaces>
void BatchTracer<N, Surfaces>::gatherMedia() {
    std::vector<const medium::Medium*> own{&scene_.medium};
    if constexpr (Surfaces)
        for (const medium::Medium& medium : scene_.interiorMedia) own.push_back(&medium);
    for (const medium::Medium* medium : own) media_.emplace_back(*medium);
    replacesMedia_ = options_.approximateMedia && !options_.approximateMedia->sets.empty();
    if (!replacesMedia_) return;
    for (const ApproximateMedia::Set& set : options_.approximateMedia->sets)
        for (std::size_t i = 0; i < own.size(); ++i) media_.emplace_back(set[i], *own[i]);
    bool flightsMeetLight = Surfaces || needs_.emission;
    for (const light::Light& light : scene_.lights.lights()) {
        const auto* sun = std::get_if<light::Sun>(&light);
        flightsMeetLight |=
            std::holds_alternative<light::Environment>(light) || (sun && !sun->delta());
    }
    octavesEnd_ = options_.approximations.octaves > 0 && !flightsMeetLight;
}

template <int N, bool Surfaces>
void BatchTracer<N, Surfaces>::sortByMediumSet() {
    if (!Surfaces && replacesMedia_)
        std::partition(paths_.begin(), paths_.end(), [](const Path& p) { return p.mediumSet > 0; });
}

template <int N, bool Surfaces>
template <class Items, class F>
void BatchTracer<N, Surfaces>::forRuns(const Items& items, F&& f) const {
    if (!replacesMedia_) {
        f(media_[0], std::size_t{0}, items.size());
        return;
    }
    for (std::size_t first = 0, end = 0; first < items.size(); first = end) {
        const std::uint8_t mediumSet = items[first].mediumSet;
        while (end < items.size() && items[end].mediumSet == mediumSet) ++end;
        f(media_[mediumSet], first, end - first);
    }
}

template <int N, bool Surfaces>
std::uint8_t BatchTracer<N, Surfaces>::mediumSetAfter(std::int64_t scatterings) const {
    const auto& after = options_.approximations.similarityAfter;
    return after && scatterings >= *after ? 1 : 0;
}

template <int N, bool Surfaces>
std::uint32_t BatchTracer<N, Surfaces>::mediumIndex(std::uint8_t mediumSet,
                                                    const MediumStack& inside) const {
    const auto setSize = static_cast<std::uint32_t>(1 + scene_.interiorMedia.size());
    return mediumSet * setSize + nestedMedia_->medium(inside);
}

/// With octaves, draws one in proportion to its amount. Light of octave i is a^i x sigma_s x
/// phase(c^i g) x transmittance of b^i sigma_t. It is found by next-event estimation and by the
/// following flight, which ends where it leaves the medium.
template <int N, bool Surfaces>
auto BatchTracer<N, Surfaces>::onwardFrom(Path& p) const -> Onward {
    const int octaves = options_.approximations.octaves;
    if (octaves == 0) return {mediumSetAfter(p.scatterings + 1)};
    const int i = medium::octave::draw(octaves, p.random.uniform());
    return {static_cast<std::uint8_t>(1 + i), medium::octave::total(octaves),
            medium::octave::phase(i)};
}

template <int N, bool Surfaces>
double BatchTracer<N, Surfaces>::enterMediumSet(Path& p) const {
    const Onward onward = onwardFrom(p);
    p.mediumSet = onward.mediumSet;
    p.throughput *= static_cast<float>(onward.amount);
    return onward.phase;
}

template <int N, bool Surfaces>
void BatchTracer<N, Surfaces>::clampRadiance(image::FilmSample& sample) {
    const auto most = static_cast<float>(options_.approximations.clamp);
    const float brightest = sample.radiance.maximum();
    if (!(most > 0 && brightest > most)) return;
    ++counters_.clamped;
    if (!std::isfinite(brightest)) return;  // the film counts it
    sample.radiance *= most / brightest;
    sample.background *= most / brightest;
}

}  // namespace woodcock::render
