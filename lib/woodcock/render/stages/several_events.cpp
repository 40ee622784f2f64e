// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/stages/several_events.h"

#include <algorithm>
#include <limits>

#include "woodcock/render/stages/inner_loops.h"
#include "woodcock/render/stages/light.h"
#include "woodcock/render/stages/roulette.h"
#include "woodcock/render/stages/turn.h"

namespace woodcock::render {

namespace {

/// The least optical depth from a point to a sun, over suns and channels.
template <int N>
float depthToSun(const TracedScene& traced, const PathState<N, false>& p) {
    float least = std::numeric_limits<float>::infinity();
    for (const int light : traced.scene.lights.sampled())
        if (const medium::DepthGrid* grid = traced.lightDepth(p.mediumSet, light))
            for (const medium::DepthGrid::Depth& d : grid->at<N>(p.from.position))
                least = std::min(least, d.depth);
    return least;
}

}  // namespace

template <int N>
bool drawsSeveralEvents(const TracedScene& traced, const PathState<N, false>& p) {
    return traced.mayScatter(p.scatterings + 1) && depthToSun(traced, p) <= nearSun;
}

template <int N>
void drawSeveralEvents(const TracedScene& traced, Batch<N, false>& batch, std::size_t i) {
    PathState<N, false>& p = batch.paths[i];
    p.sunShare = 1;
    if (!drawsSeveralEvents(traced, p)) return;
    p.sunShare = severalEventsShare;
    const medium::Medium& medium = *traced.media[p.medium].medium;
    const PathState<N, false> path = p;
    RandomStream random(p.random.bits());
    for (int k = 0; k < severalEvents; ++k) {
        p.throughput = path.throughput, p.random = random;
        const medium::PhaseSample s =
            turn(p, *path.from.phase, {p.random.uniform(), p.random.uniform()});
        medium::DistanceQuery<N> flight;
        flight.origin = path.from.position, flight.direction = s.direction;
        flight.tMax = std::numeric_limits<double>::infinity(), flight.time = p.time;
        flight.u = p.random.uniformOpenLow(), flight.random = p.random;
        flight.roulette = pathRoulette, flight.throughput = p.throughput;
        medium::TrackingCounters c;
        findEvents<N>(traced.options.approximations, medium, {&flight, 1}, c);
        batch.counters.distanceSegments += c.segments;
        batch.counters.distanceCollisions += c.collisions;
        p.random = flight.random, p.throughput = flight.throughput;
        if (flight.part >= 0 && p.throughput.maximum() > 0) {
            p.from = {path.from.position + s.direction * flight.t, s.direction,
                      &medium.parts[static_cast<std::size_t>(flight.part)].phase(), p.time};
            p.scatterings = path.scatterings + 1;
            ++batch.counters.scatterings;
            EventNumbers u{};
            u.light = {p.random.uniform(), p.random.uniform()}, u.pick = p.random.uniform();
            addSunlight(traced, batch, i, u);
        }
        random = p.random;
    }
    p.throughput = path.throughput, p.random = path.random;
    p.from = path.from, p.scatterings = path.scatterings;
}

template bool drawsSeveralEvents(const TracedScene&, const PathState<1, false>&);
template bool drawsSeveralEvents(const TracedScene&, const PathState<3, false>&);
template void drawSeveralEvents(const TracedScene&, Batch<1, false>&, std::size_t);
template void drawSeveralEvents(const TracedScene&, Batch<3, false>&, std::size_t);

}  // namespace woodcock::render
