// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/stages/walk.h"

#include "woodcock/render/stages/camera_stops.h"
#include "woodcock/render/stages/inner_loops.h"
#include "woodcock/render/stages/roulette.h"

namespace woodcock::render {

namespace {

/// In a medium that only absorbs: its paths reach their ends, weighted by the transmittance.
template <int N, bool Surfaces>
void absorbAlong(const TracedScene& traced, Batch<N, Surfaces>& batch, const MediumSummary& medium,
                 std::span<medium::DistanceQuery<N>> walks, std::span<const MediumRuns::Item> items,
                 medium::TrackingCounters& c) {
    batch.absorbed.clear();
    for (std::size_t k = 0; k < walks.size(); ++k) {
        const std::size_t path = items[k].query;
        batch.absorbed.push_back(
            {.origin = walks[k].origin,
             .direction = walks[k].direction,
             .tMax = walks[k].tMax,
             .time = walks[k].time,
             .random = walks[k].random,
             .contribution = walks[k].throughput,
             .opacityToo = seen(batch.paths[path]),
             .depthAlong = walks[k].collisions ? &batch.depths[path] : nullptr});
    }
    findTransmittances<N>(traced.options.approximations, *medium.medium, batch.absorbed, c);
    for (std::size_t k = 0; k < walks.size(); ++k) {
        const medium::TransmittanceQuery<N>& q = batch.absorbed[k];
        PathState<N, Surfaces>& p = batch.paths[items[k].query];
        if (q.opacityToo && traced.options.approximations.marchStep == 0)
            p.opacity = Spectrum<N>::map(
                [&](int i) { return p.opacity[i] + (1 - p.opacity[i]) * q.opacity[i]; });
        walks[k].random = q.random, walks[k].throughput = q.contribution;
    }
}

}  // namespace

template <int N, bool Surfaces>
void walk(const TracedScene& traced, Batch<N, Surfaces>& batch) {
    batch.walks.clear(), batch.runs.clear();
    for (std::size_t i = 0; i < batch.paths.size(); ++i) {
        const PathState<N, Surfaces>& p = batch.paths[i];
        const Flight flight = traced.flightOf(p);
        medium::DistanceQuery<N>& q = batch.walks.emplace_back();
        q.origin = flight.origin, q.direction = flight.direction;
        q.tMax = flight.tMax, q.time = flight.time, q.u = p.flight;
        q.random = p.random, q.roulette = pathRoulette, q.throughput = p.throughput;
        q.collisions = collisionsToNote(traced, batch, i);
        if (!flight.medium->medium->parts.empty()) batch.runs.add(p.medium, i);
    }
    medium::TrackingCounters c;
    batch.runs.forEach(batch.walks, batch.sortedWalks,
                       [&](std::uint32_t number, std::span<medium::DistanceQuery<N>> walks,
                           std::span<const MediumRuns::Item> items) {
                           const MediumSummary& medium = traced.media[number];
                           if (medium.scatters)
                               findEvents<N>(traced.options.approximations, *medium.medium, walks,
                                             c);
                           else
                               absorbAlong(traced, batch, medium, walks, items, c);
                       });
    if (traced.options.stoppedLight)
        for (std::size_t i = 0; i < batch.paths.size(); ++i) noteStops(traced, batch, i);
    batch.counters.distanceSegments += c.segments;
    batch.counters.distanceCollisions += c.collisions;
}

template void walk(const TracedScene&, Batch<1, false>&);
template void walk(const TracedScene&, Batch<1, true>&);
template void walk(const TracedScene&, Batch<3, false>&);
template void walk(const TracedScene&, Batch<3, true>&);

}  // namespace woodcock::render
