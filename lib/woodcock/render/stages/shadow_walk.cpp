// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/stages/shadow_walk.h"

#include <cmath>

#include "woodcock/medium/corrected_transmittance.h"
#include "woodcock/render/stages/inner_loops.h"
#include "woodcock/render/stages/light.h"

namespace woodcock::render {

namespace {

/// Shadow rays end this much, relatively, before a light that is a surface itself.
constexpr double beforeLight = 1 - 1e-7;
/// Where such a light may coincide with other surfaces, they end this far behind it.
constexpr double behindLight = 1 + 1e-6;

/// Weights the queries by the transmittance of their media: those that were added to batch.runs.
template <int N, bool Surfaces>
void passMedia(const TracedScene& traced, Batch<N, Surfaces>& batch, medium::TrackingCounters& c) {
    batch.runs.forEach(batch.shadowQueries, batch.sortedShadows,
                       [&](std::uint32_t number, std::span<medium::TransmittanceQuery<N>> queries,
                           std::span<const MediumRuns::Item>) {
                           findTransmittances<N>(traced.options.approximations,
                                                 *traced.media[number].medium, queries, c);
                       });
}

/// Where an emitter coincides with other surfaces, a shadow ray reaches it only if it is the one
/// that counts.
bool arrives(const NestedMedia& media, const ShadowRay<true>& shadow,
             const surface::SurfaceHit& hit, double left) {
    if (hit.coincident.any) return media.emitter(hit) == shadow.emitter;
    return hit.t > left * beforeLight;
}

/// Follows one shadow ray through boundaries that light passes. Adds its straight pieces to
/// batch.pieces. Weights its query by what it passes; by 0 where a surface stops it.
template <int N>
void followThroughSurfaces(const TracedScene& traced, Batch<N, true>& batch, std::size_t i) {
    const ShadowRay<true>& shadow = batch.shadows[i];
    medium::TransmittanceQuery<N>& q = batch.shadowQueries[i];
    if (!(q.contribution.maximum() > 0)) return;
    const NestedMedia& media = *traced.surfaces;
    const std::size_t firstPiece = batch.pieces.size();
    const auto stop = [&] {
        q.contribution = {};
        batch.pieces.resize(firstPiece);
    };
    const bool toSurface = shadow.emitter != light::LightSample::none;
    BoundaryWalk way(shadow.start);
    Vec3d origin = q.origin;
    double left = q.tMax;
    Rgb passed(1.0f);
    while (true) {
        bool hits = false;
        if (!shadow.withinFlight) {
            ++batch.counters.surfaceRays;
            hits = way.next(media, {.origin = origin,
                                    .direction = q.direction,
                                    .time = q.time,
                                    .tMax = left * (toSurface ? behindLight : beforeLight)});
            if (hits && toSurface) hits = !arrives(media, shadow, way.hit(), left);
        }
        batch.pieces.push_back({.shadow = static_cast<std::uint32_t>(i),
                                .medium = traced.mediumAround(shadow.mediumSet, way.inside()),
                                .origin = origin,
                                .length = hits ? way.hit().t : left});
        if (!hits) break;
        if (media.opaque(way.hit())) {
            stop();
            return;
        }
        const Crossing crossing = way.crossing(media, q.direction);
        if (!crossing.passes) {
            if (!shadow.transparent || crossing.bsdf.smooth() || !crossing.bsdf.transmits()) {
                stop();
                return;
            }
            passed = passed * crossing.bsdf.straightTransmittance(q.direction);
        }
        way.pass(crossing);
        origin = way.hit().position;
        left -= way.hit().t;
    }
    q.contribution *= passed.mean();
}

/// Brings the light of a sun or lamp whose optical depth is in a grid, where the ray meets no
/// boundary: its only piece, the last that was added, goes through the outer medium all the way.
/// Nothing is left of it then.
template <int N>
void arriveByGrid(const TracedScene& traced, Batch<N, true>& batch, std::size_t i,
                  medium::TrackingCounters& c) {
    const ShadowRay<true>& shadow = batch.shadows[i];
    medium::TransmittanceQuery<N>& q = batch.shadowQueries[i];
    const ShadowPiece piece = batch.pieces.back();
    if (piece.medium != traced.media.number(shadow.mediumSet, 0)) return;
    const Spectrum<N> passes = medium::correctedTransmittance<N>(
        *traced.media[piece.medium].medium, *shadow.lightDepth, piece.origin, q.direction,
        q.contribution * (1 / traced.typicalRadiance), q.random, c);
    bring(batch, batch.paths[shadow.path], shadow.colour * toRgb(q.contribution * passes),
          shadow.kind, shadow.group, shadow.inFront);
    q.contribution = {};
    batch.pieces.pop_back();
}

/// What stops a ray is found before its media are tracked, for most rays that are stopped are so by
/// surfaces. Then the first pieces of all rays are tracked by runs of one medium, then the second
/// pieces of those that go on, and so forth.
template <int N>
void passSurfacesAndMedia(const TracedScene& traced, Batch<N, true>& batch,
                          medium::TrackingCounters& c) {
    batch.pieces.clear();
    for (std::size_t i = 0; i < batch.shadows.size(); ++i) {
        const std::size_t pieces = batch.pieces.size();
        followThroughSurfaces(traced, batch, i);
        if (batch.shadows[i].lightDepth && batch.pieces.size() == pieces + 1)
            arriveByGrid(traced, batch, i, c);
    }
    for (std::size_t left = batch.pieces.size(); left > 0;) {
        batch.runs.clear();
        std::size_t later = 0;
        for (std::size_t k = 0, before = 0; k < left; ++k) {
            const ShadowPiece piece = batch.pieces[k];
            const bool first = k == 0 || before != piece.shadow;
            before = piece.shadow;
            medium::TransmittanceQuery<N>& q = batch.shadowQueries[piece.shadow];
            if (!first) {
                batch.pieces[later++] = piece;
                continue;
            }
            if (!(q.contribution.maximum() > 0) || traced.media[piece.medium].medium->parts.empty())
                continue;
            q.origin = piece.origin, q.tMax = piece.length;
            batch.runs.add(piece.medium, piece.shadow);
        }
        passMedia(traced, batch, c);
        left = later;
    }
}

/// Adds what has arrived. What is left are the second legs of rays that have two.
template <int N, bool Surfaces>
void arrive(Batch<N, Surfaces>& batch) {
    std::size_t left = 0;
    for (std::size_t i = 0; i < batch.shadows.size(); ++i) {
        const Spectrum<N> arrived = batch.shadowQueries[i].contribution;
        if (!(arrived.maximum() > 0)) continue;
        if (const ShadowRay<Surfaces>& ray = batch.shadows[i]; !ray.secondLeg) {
            PathState<N, Surfaces>& p = batch.paths[ray.path];
            const Rgb light = ray.colour * toRgb(arrived);
            bring(batch, p, light, ray.kind, ray.group, ray.inFront);
            if (ray.cameraDepth >= 0)
                p.result->stopped->arrivals.push_back({ray.cameraDepth, light, ray.fromLamp});
            continue;
        }
        ShadowRay<Surfaces> s = batch.shadows[i];
        s.secondLeg = s.withinFlight = false, s.mediumSet = s.secondMediumSet;
        medium::TransmittanceQuery<N> q = batch.shadowQueries[i];
        q.origin = s.origin, q.direction = s.direction, q.tMax = s.tMax;
        if constexpr (Surfaces) s.start.left.reset();
        batch.shadows[left] = s, batch.shadowQueries[left] = q, ++left;
    }
    batch.shadows.erase(batch.shadows.begin() + static_cast<std::ptrdiff_t>(left),
                        batch.shadows.end());
    batch.shadowQueries.erase(batch.shadowQueries.begin() + static_cast<std::ptrdiff_t>(left),
                              batch.shadowQueries.end());
}

}  // namespace

template <int N, bool Surfaces>
void shadowWalk(const TracedScene& traced, Batch<N, Surfaces>& batch) {
    medium::TrackingCounters c;
    batch.counters.shadowRays += batch.shadows.size();
    while (!batch.shadows.empty()) {
        if constexpr (Surfaces) {
            passSurfacesAndMedia(traced, batch, c);
        } else if (!traced.media.replaces()) {
            findTransmittances<N>(traced.options.approximations, *traced.media[0].medium,
                                  batch.shadowQueries, c);
        } else {
            batch.runs.clear();
            for (std::size_t i = 0; i < batch.shadows.size(); ++i)
                batch.runs.add(traced.media.number(batch.shadows[i].mediumSet, 0), i);
            passMedia(traced, batch, c);
        }
        arrive(batch);
    }
    batch.counters.shadowSegments += c.segments;
    batch.counters.shadowCollisions += c.collisions;
}

template void shadowWalk(const TracedScene&, Batch<1, false>&);
template void shadowWalk(const TracedScene&, Batch<1, true>&);
template void shadowWalk(const TracedScene&, Batch<3, false>&);
template void shadowWalk(const TracedScene&, Batch<3, true>&);

}  // namespace woodcock::render
