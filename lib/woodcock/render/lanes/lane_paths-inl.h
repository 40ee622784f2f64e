// SPDX-License-Identifier: Apache-2.0
// Compiled once for each set of instructions: see trace_lanes.cpp.
#if defined(WOODCOCK_LANE_PATHS) == defined(HWY_TARGET_TOGGLE)
#ifdef WOODCOCK_LANE_PATHS
#undef WOODCOCK_LANE_PATHS
#else
#define WOODCOCK_LANE_PATHS
#endif

#include <algorithm>
#include <cmath>

#include "woodcock/render/lanes/lane_tracer-inl.h"
#include "woodcock/render/light_choice.h"
#include "woodcock/render/stages/camera_stops.h"
#include "woodcock/render/stages/light.h"

HWY_BEFORE_NAMESPACE();
namespace woodcock::render::HWY_NAMESPACE {

/// Gives a lane the next path.
template <int N>
void LaneTracer<N>::nextPath(std::size_t lane) {
    while (nextPath_ < batch_.paths.size()) {
        Lane& l = lanes_[lane];
        l.path = static_cast<std::uint32_t>(nextPath_++);
        l.extra = false, l.first = true, l.scatterings = 0;
        PathState<N, false>& p = pathOf(lane);
        l.set = p.mediumSet, p.medium = traced_.media.number(p.mediumSet, 0);
        for (int i = 0; i < 3; ++i) v_[i][lane] = static_cast<float>(p.direction[i]);
        const std::uint64_t key = p.random.bits();
        key_[0][lane] = static_cast<std::uint32_t>(key);
        key_[1][lane] = static_cast<std::uint32_t>(key >> 32);
        count_[lane] = 0;
        density_[lane] = 0, scattered_[lane] = 0, share_[lane] = 1;
        setLane(w_, lane, p.throughput);
        collisionsToNote(traced_, batch_, l.path);  // makes room
        if (!scene_.emission.empty()) lookForEmission(lane, nullptr);
        if (scatterCameraRay(lane)) {
            if (nextPoint(lane)) return;
            endCameraPath(lane);
        } else {
            if (begin(lane, p.origin, static_cast<float>(-std::log(p.flight)))) return;
            leave(lane);
        }
        p.alive = false;
    }
    state_[lane] = Idle;
}

/// Looks for what glows along the camera's ray or, where the path has scattered in `scatters`,
/// along rays from there.
template <int N>
void LaneTracer<N>::lookForEmission(std::size_t lane, const LanePart* scatters) {
    const Lane& l = lanes_[lane];
    PathState<N, false>& p = pathOf(lane);
    EmissionVertex<N> vertex{.path = l.path,
                             .set = l.set,
                             .kind = kindOfLight(p, scatters ? 1 : 0),
                             .position = scatters ? positionOf(lane) : p.origin,
                             .direction = scatters ? directionOf(lane) : p.direction,
                             .scatters = scatters,
                             .throughput = throughputOf(lane),
                             .key = p.random.bits(),
                             .u = {p.equiangular, 0},
                             .raster = p.raster};
    if (!scatters && isToBeNoted(traced_, p)) vertex.depth.emplace(traced_, p);
    if (scatters) {
        // As many as its light is worth: of 3 to 12 rays for a weight of 1, 9 measured best.
        constexpr float raysPerWeight = 9, mostRays = 4;
        if (l.fromCamera) vertex.correction = l.points[l.point].correction;
        if (p.scatterings < 2) {
            const Spectrum<N> brings = vertex.throughput * vertex.correction;
            const float weight =
                Spectrum<N>::map([&](int c) { return std::abs(brings[c]); }).maximum();
            vertex.rays =
                static_cast<int>(std::clamp(std::ceil(raysPerWeight * weight), 1.0f, mostRays));
        }
        if (l.quasiRandom)
            vertex.u = numbers_[lane].light;
        else
            vertex.u = {p.random.uniform(), p.random.uniform()};
    }
    emission_.add(vertex);
}

/// Where the lane's flight is to note its collisions; null: nowhere.
template <int N>
std::vector<medium::FlightCollision>* LaneTracer<N>::collisionsOf(std::size_t lane) {
    const bool notes = isToBeNoted(traced_, pathOf(lane));
    return notes ? &batch_.collisions[lanes_[lane].path] : nullptr;
}

/// The path has left the medium.
template <int N>
void LaneTracer<N>::leave(std::size_t lane) {
    PathState<N, false>& p = pathOf(lane);
    p.throughput = throughputOf(lane);
    if (scene_.controlsFlights && scattered_[lane] > 0) noteLeaving(lane);
    const bool first = seen(p);
    if (first)
        endCameraFlight(lane, false);
    else
        p.direction = directionOf(lane);
    const light::LightSet& lights = traced_.scene.lights;
    for (const int light : lights.distant()) {
        const Rgb radiance = lights.distantRadiance(light, p.direction, first);
        if (!(radiance.maximum() > 0)) continue;
        const Rgb arrived =
            toRgb(p.throughput) * radiance * static_cast<float>(first ? 1 : hitWeight(lane, light));
        const image::LightKind kind = first ? image::LightKind::Background : kindOfLight(p, 0);
        bring(batch_, p, arrived, kind, lights.group(light));
        if (first) p.result->film.background += arrived;
    }
    if (first) return;  // addLightHits() has added the lamps that camera rays meet
    for (const int light : lights.meetable()) {
        const light::LightHit hit = lights.meet(light, p.from.position, p.direction);
        if (std::isfinite(hit.distance))
            bring(batch_, p,
                  toRgb(p.throughput) * hit.radiance * static_cast<float>(hitWeight(lane, light)),
                  kindOfLight(p, 0), lights.group(light));
    }
}

/// The weight, by multiple importance sampling, of a light that a scattered path meets.
template <int N>
double LaneTracer<N>::hitWeight(std::size_t lane, int light) {
    const PathState<N, false>& p = pathOf(lane);
    const auto other = std::ranges::find(scene_.others, light);
    if (light != scene_.sun && other == scene_.others.end()) return 1;
    double pdf = traced_.scene.lights.pdf(light, p.from.position, p.direction, p.time);
    if (pdf > 0 && light != scene_.sun) {
        findProbabilities(p.from);
        pdf *= double{probabilities_[static_cast<std::size_t>(other - scene_.others.begin())]};
    }
    return powerHeuristic(double{density_[lane]}, pdf);
}

/// A flight has ended without an event. `lost`: its light was taken; else it has left the medium.
template <int N>
void LaneTracer<N>::end(std::size_t lane, bool lost) {
    if (lanes_[lane].extra) {
        endExtra(lane);
        return;
    }
    PathState<N, false>& p = pathOf(lane);
    if (!lost) {
        leave(lane);
    } else if (seen(p)) {
        p.throughput = {};
        endCameraFlight(lane, false);
    }
    endBranch(lane);
}

template <int N>
void LaneTracer<N>::endCameraFlight(std::size_t lane, bool scattered) {
    PathState<N, false>& p = pathOf(lane);
    p.result->film.alpha = scattered ? 1 : opacityOf(p);
    if (!isToBeNoted(traced_, p)) return;
    noteStops(traced_, batch_, lanes_[lane].path);
    if (scattered) noteFirstScattering(traced_, p, lanes_[lane].flightStart + double{t_[lane]});
}

/// A branch of the path has ended: follows the next one, or gives the lane another path.
template <int N>
void LaneTracer<N>::endBranch(std::size_t lane) {
    Lane& l = lanes_[lane];
    PathState<N, false>& p = pathOf(lane);
    l.scatterings += p.scatterings;
    if (l.branches.empty()) {
        if (l.fromCamera) {
            endPoint(lane), ++l.point;
            if (nextPoint(lane)) return;
            endCameraPath(lane);
        } else {
            bringControls(lane);
        }
        p.alive = false, p.scatterings = l.scatterings;  // as a measure of work
        nextPath(lane);
        return;
    }
    Branch& b = l.branches.back();
    l.set = p.mediumSet = b.set, l.part = b.part;
    put(lane, b.vertex);
    scatterIn(lane);
    l.phase = b.phase, g_[lane] = phaseOf(lane).g;
    for (std::size_t i = 0; i < 3; ++i) v_[i][lane] = b.direction[i];
    if (scene_.radiance) findExpected(1u << lane);
    turnToLamp(1u << lane);
    setLane(w_, lane, b.throughput), setLane(predicted_, lane, b.predicted);
    share_[lane] = 1;
    l.scatterings -= b.scatterings;  // they are the first branch's too
    p.scatterings = b.scatterings, p.alive = true, p.from = b.from;
    l.first = l.quasiRandom = false;
    if (several_) l.position = positionOf(lane);
    if (--b.copies == 0) l.branches.pop_back();
    state_[lane] = Departing;
}

/// Adds what the control variates have come to. Their means are zero, whatever came before, so
/// layers may count them as indirect light of the medium.
template <int N>
void LaneTracer<N>::bringControls(std::size_t lane) {
    PathState<N, false>& p = pathOf(lane);
    const light::LightSet& lights = traced_.scene.lights;
    constexpr auto kind = image::LightKind::VolumeIndirect;
    if (scene_.chanceLight >= 0)
        bring(batch_, p, toRgb(laneOf(chance_, lane)) * scene_.chanceUnit * -1.0f, kind,
              lights.group(scene_.chanceLight));
    if (scene_.sun >= 0)
        bring(batch_, p, toRgb(laneOf(prediction_, lane)) * scene_.centre.weight, kind,
              lights.group(scene_.sun));
    for (Floats* rows : {chance_, prediction_, predicted_}) setLane(rows, lane, Spectrum<N>());
}

}  // namespace woodcock::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
