// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/stages/retire.h"

#include <cmath>
#include <span>

#include "woodcock/render/stages/camera_stops.h"

namespace woodcock::render {

namespace {

/// Approximations::clamp.
void clampRadiance(double clamp, image::FilmSample& sample, std::span<Rgb> parts,
                   RenderCounters& counters) {
    const auto most = static_cast<float>(clamp);
    const float brightest = sample.radiance.maximum();
    if (!(most > 0 && brightest > most)) return;
    ++counters.clamped;
    if (!std::isfinite(brightest)) return;  // the film counts it
    sample.radiance *= most / brightest;
    sample.background *= most / brightest;
    for (Rgb& part : parts) part *= most / brightest;
}

template <int N, bool Surfaces>
void handIn(const PathState<N, Surfaces>& p) {
    p.result->film.events = static_cast<float>(p.scatterings);
    if constexpr (Surfaces) p.result->film.events += static_cast<float>(p.surfaces.bounces);
    if (p.result->catcher.weight > 0)
        p.result->catcher.lit = p.radiance.mean();
    else
        p.result->film.radiance += p.radiance;
}

}  // namespace

template <int N, bool Surfaces>
void retire(const TracedScene& traced, Batch<N, Surfaces>& batch) {
    for (std::size_t i = 0; i < batch.paths.size();) {
        PathState<N, Surfaces>& p = batch.paths[i];
        if (p.alive) {
            ++i;
            continue;
        }
        handIn(p);
        clampRadiance(traced.options.approximations.clamp, p.result->film,
                      batch.layers.partsOf(*p.result), batch.counters);
        if (traced.options.stoppedLight) completeStops(*p.result);
        if (&p != &batch.paths.back()) p = batch.paths.back();  // the order does not matter
        batch.paths.pop_back();
    }
}

template void retire(const TracedScene&, Batch<1, false>&);
template void retire(const TracedScene&, Batch<1, true>&);
template void retire(const TracedScene&, Batch<3, false>&);
template void retire(const TracedScene&, Batch<3, true>&);

}  // namespace woodcock::render
