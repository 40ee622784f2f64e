// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/stages/camera_layers.h"

#include "woodcock/medium/features.h"
#include "woodcock/render/next_frame.h"
#include "woodcock/render/stages/inner_loops.h"

namespace woodcock::render {

namespace {

/// What a camera ray meets first.
template <int N>
struct FirstMet {
    medium::DistanceQuery<N> query;  ///< of the last piece of the ray; part >= 0: in a medium there
    const medium::Medium* medium = nullptr;
    double before = 0;            ///< length of the ray before that piece
    std::size_t mediumIndex = 0;  ///< 0: Scene::medium, else of interiorMedia, from 1
    bool holdout = false, surface = false;
    Vec3d position = {};  ///< of a surface, and its instance
    std::size_t instance = 0;
};

template <int N>
void writeSurface(const FirstMet<N>& met, const surface::SurfaceHit& hit, const surface::Bsdf& bsdf,
                  image::DepthSample& depth) {
    const Spectrum<N>& throughput = met.query.throughput;
    const float weight = throughput.mean();
    const Vec3d n =
        hit.shadingNormal * (dot(hit.normal, met.query.direction) < 0 ? weight : -weight);
    depth = {{},
             weight * static_cast<float>(met.before + hit.t),
             weight,
             toRgb(throughput) * bsdf.albedo(),
             n.as<float>()};
}

template <int N>
void writeMedium(const FirstMet<N>& met, bool featureLayers, image::DepthSample& depth) {
    const medium::DistanceQuery<N>& q = met.query;
    if (q.part < 0) {
        depth.transmittance = toRgb(q.throughput);
        return;
    }
    const float weight = q.throughput.mean();
    depth.weightedDepth = weight * static_cast<float>(met.before + q.t);
    depth.weight = weight;
    if (!featureLayers) return;
    const Vec3d position = q.origin + q.direction * q.t;
    depth.weightedAlbedo =
        toRgb(q.throughput) * medium::scatteringAlbedo(*met.medium, position, q.time);
    depth.weightedNormal =
        (medium::densityNormal(*met.medium, position, q.time) * weight).template as<float>();
}

template <int N>
image::PlaceSample placeOf(const TracedScene& traced, const FirstMet<N>& met,
                           const image::DepthSample& depth) {
    const medium::DistanceQuery<N>& q = met.query;
    const float weight = depth.weight;
    if (!(weight > 0)) return {};
    const Vec3d at = met.surface ? met.position : q.origin + q.direction * q.t;
    image::PlaceSample place{.weightedPosition = at * weight};
    if (const NextFrame* next = traced.scene.next.get()) {
        const NextFrame::Way& way =
            met.surface ? next->ofInstance(met.instance)
                        : next->ofPart(met.mediumIndex, static_cast<std::size_t>(q.part));
        const auto motion = next->motion(way, at, traced.options.width, traced.options.height);
        place.weightedMotion = {motion[0] * weight, motion[1] * weight};
    }
    return place;
}

/// Follows the ray through boundaries to what it meets first. A surface is written at once.
template <int N>
void followThroughSurfaces(const TracedScene& traced, const PathState<N, true>& p,
                           FirstMet<N>& met) {
    const NestedMedia& media = *traced.surfaces;
    medium::DistanceQuery<N>& q = met.query;
    medium::TrackingCounters c;
    BoundaryWalk way = p.surfaces.way;
    while (true) {
        const bool hits = way.next(
            media,
            {.origin = q.origin, .direction = q.direction, .time = q.time, .cameraRay = true});
        q.tMax = way.tMax();
        met.medium = traced.media[traced.mediumAround(p.mediumSet, way.inside())].medium;
        met.mediumIndex = media.medium(way.inside());
        findEvents<N>(traced.options.approximations, *met.medium, {&q, 1}, c);
        if (q.part >= 0 || !hits) return;
        const surface::SurfaceHit& hit = way.hit();
        const Crossing crossing = way.crossing(media, q.direction);
        met.holdout = media.object(hit).holdout;
        if (met.holdout) return;
        if (!crossing.passes) {
            met.surface = true;
            met.position = hit.position, met.instance = hit.instance;
            writeSurface(met, hit, crossing.bsdf, p.result->depth);
            return;
        }
        way.pass(crossing);
        met.before += hit.t;
        q.origin = hit.position, q.u = q.random.uniformOpenLow();
    }
}

}  // namespace

template <int N, bool Surfaces>
void sampleCameraLayers(const TracedScene& traced, const PathState<N, Surfaces>& p,
                        image::PlaceSample* place) {
    FirstMet<N> met{.query = {.origin = p.origin,
                              .direction = p.direction,
                              .tMax = std::numeric_limits<double>::infinity(),
                              .time = p.time,
                              .u = p.flight,
                              .random = RandomStream(RandomStream(p.random).bits()),
                              .absorptionToo = true,
                              .throughput = Spectrum<N>(1.0f)}};
    if constexpr (Surfaces) {
        followThroughSurfaces(traced, p, met);
        if (met.surface && place) *place = placeOf(traced, met, p.result->depth);
        if (met.holdout || met.surface) return;
    } else {
        medium::TrackingCounters c;
        met.medium = traced.media[traced.media.number(p.mediumSet, 0)].medium;
        findEvents<N>(traced.options.approximations, *met.medium, {&met.query, 1}, c);
    }
    writeMedium(met, traced.options.layers.features, p.result->depth);
    if (place) *place = placeOf(traced, met, p.result->depth);
}

template void sampleCameraLayers(const TracedScene&, const PathState<1, false>&,
                                 image::PlaceSample*);
template void sampleCameraLayers(const TracedScene&, const PathState<1, true>&,
                                 image::PlaceSample*);
template void sampleCameraLayers(const TracedScene&, const PathState<3, false>&,
                                 image::PlaceSample*);
template void sampleCameraLayers(const TracedScene&, const PathState<3, true>&,
                                 image::PlaceSample*);

}  // namespace woodcock::render
