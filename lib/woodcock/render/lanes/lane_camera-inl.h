// SPDX-License-Identifier: Apache-2.0
// Compiled once for each set of instructions: see trace_lanes.cpp.
#if defined(WOODCOCK_LANE_CAMERA) == defined(HWY_TARGET_TOGGLE)
#ifdef WOODCOCK_LANE_CAMERA
#undef WOODCOCK_LANE_CAMERA
#else
#define WOODCOCK_LANE_CAMERA
#endif

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "woodcock/medium/optical_depth.h"
#include "woodcock/render/lanes/lane_depths-inl.h"
#include "woodcock/render/lanes/lane_tracer-inl.h"
#include "woodcock/render/stages/camera_stops.h"

HWY_BEFORE_NAMESPACE();
namespace woodcock::render::HWY_NAMESPACE {

/// So often the point of a camera ray is drawn evenly, so that it may be wherever the medium is.
inline constexpr double evenPoints = 1.0 / 32;

/// Draws where a camera ray scatters, by the depths along it, and weights the path by what
/// scatters there. The light behind the medium is added for what passes. So no chance decides
/// between the two. False: the ray has no such depths.
///
/// All that the path brings is proportional to the transmittance up to where it scatters, which the
/// depths estimate. As in correctedTransmittance(), rare exact integrations correct it: by a factor
/// for the path, see endCameraPath().
template <int N>
bool LaneTracer<N>::scatterCameraRay(std::size_t lane) {
    Lane& l = lanes_[lane];
    PathState<N, false>& p = pathOf(lane);
    l.fromCamera = scene_.cameraDepths && l.set == 0;
    if (!l.fromCamera) return false;
    l.cameraDirection = p.direction, l.correction = Spectrum<N>(1.0f), l.worth = Spectrum<N>();
    const CameraDepths::Ray ray = scene_.cameraDepths->at(p.raster[0], p.raster[1]);
    const DepthsAhead<N> ahead(*scene_.cameraDepths, ray, scene_.parts.data());
    l.passes = transmittanceOf<N>(ahead.whole());
    std::ranges::fill(l.stopped, Spectrum<N>());
    double t0 = std::numeric_limits<double>::infinity(), t1 = 0;
    for (std::size_t k = 0; k < scene_.partCount; ++k) {
        const medium::MediumPart& part = *scene_.parts[k].part;
        double enters = 0, leaves = std::numeric_limits<double>::infinity();
        if (grid::clip(part.indexRay(p.origin, p.direction), part.support(), enters, leaves))
            t0 = std::min(t0, enters), t1 = std::max(t1, leaves);
    }
    state_[lane] = Idle;
    if (!(t0 < t1)) {
        l.passes = Spectrum<N>(1.0f);
        return true;
    }
    l.worth = worthOf(p);
    // Of each channel, the share of the points that are drawn by its depth.
    float shares[N], sum = 0;
    for (int c = 0; c < N; ++c)
        sum += shares[c] = -std::expm1(-ahead.whole()[c]) * scene_.cameraAlbedo[c];
    const double even = sum > 0 ? evenPoints : 1;
    double u = p.flight, t = t0 + (t1 - t0) * u / even;
    if (u >= even) {
        u = (u - even) / (1 - even) * double{sum};
        int c = 0;
        while (c + 1 < N && u >= double{shares[c]}) u -= double{shares[c++]};
        const auto scattered = std::min(1.0f - 0x1p-24f, static_cast<float>(u / double{shares[c]}));
        t = ahead.find(c, -std::log1p(scattered * std::expm1(-ahead.whole()[c])));
    }
    const typename DepthsAhead<N>::Place place = ahead.at(t);
    double density = t > t0 && t < t1 ? even / (t1 - t0) : 0;
    for (int c = 0; c < N; ++c)
        if (sum > 0)
            density += (1 - even) * double{scene_.cameraAlbedo[c] / sum} * double{place.slope[c]} *
                       std::exp(-double{place.depth[c]});
    l.flightStart = t;
    const float chance = ahead.correctionChance(place.step + 1);
    const Spectrum<N> estimate = transmittanceOf<N>(place.depth);
    if (p.random.uniform() < double{chance}) correctCameraRay(lane, t, estimate, chance);
    return density > 0 ? scatterAt(lane, t, estimate * static_cast<float>(1 / density)) : true;
}

/// What light that stops on a path's camera ray is expected to bring. Where it stops is chance, and
/// so is what a correction changes; this takes both off. It is found for the ray through the
/// pixel's middle, where a third of what stops on that ray has stopped.
template <int N>
Spectrum<N> LaneTracer<N>::worthOf(const PathState<N, false>& p) {
    if (!scene_.radiance) return channels<N>(scene_.cameraAlbedo);
    const int x = static_cast<int>(p.raster[0]), y = static_cast<int>(p.raster[1]);
    if (worth_.x == x && worth_.y == y) return worth_.value;
    const CameraDepths& depths = *scene_.cameraDepths;
    const DepthsAhead<N> ahead(depths, depths.at(x + 0.5, y + 0.5), scene_.parts.data());
    const Spectrum<N>& whole = ahead.whole();
    int channel = 0;
    for (int c = 1; c < N; ++c)
        if (whole[c] > whole[channel]) channel = c;
    const double t = ahead.find(channel, -std::log1p(std::expm1(-whole[channel]) / 3));
    const camera::CameraRay ray = traced_.cameraRays.at(x + 0.5, y + 0.5, 0);
    worth_ = {
        x, y,
        scene_.radiance->template scattered<N>(ray.origin + ray.direction * t, ray.direction) *
            channels<N>(scene_.cameraAlbedo)};
    return worth_.value;
}

/// Integrates a camera ray exactly, up to `t` and beyond.
template <int N>
void LaneTracer<N>::correctCameraRay(std::size_t lane, double t, const Spectrum<N>& estimate,
                                     float chance) {
    Lane& l = lanes_[lane];
    const PathState<N, false>& p = pathOf(lane);
    const medium::Medium& medium = traced_.mediumOfSet(0);
    const Spectrum<N> before = channels<N>(
                          medium::exactOpticalDepth(medium, p.origin, p.direction, 0, t)),
                      behind = channels<N>(
                          medium::exactOpticalDepth(medium, p.origin, p.direction, t,
                                                    std::numeric_limits<double>::infinity()));
    for (int c = 0; c < N; ++c) {
        l.correction[c] += (std::exp(-before[c]) / estimate[c] - 1) / chance;
        l.passes[c] += (std::exp(-before[c] - behind[c]) - l.passes[c]) / chance;
    }
}

/// Puts the lane's path to a point of its camera ray, where it scatters; its throughput becomes
/// `weight` times the density of the scattering. It scatters nowhere where nothing is there.
template <int N>
bool LaneTracer<N>::scatterAt(std::size_t lane, double t, const Spectrum<N>& weight) {
    Lane& l = lanes_[lane];
    PathState<N, false>& p = pathOf(lane);
    const Vec3d at = p.origin + p.direction * t;
    Spectrum<N> scattered[CameraDepths::mostParts];
    float shares[CameraDepths::mostParts], sum = 0;
    for (std::size_t k = 0; k < scene_.partCount; ++k) {
        const medium::MediumPart& part = *scene_.parts[k].part;
        const float f = part.field()->trilinear(part.indexRay(at, p.direction).origin);
        scattered[k] = weight * channels<N>(part.scattering()) * f;
        sum += shares[k] = scattered[k].mean();
        l.stopped[k] = weight * channels<N>(part.extinction()) * f;
        setLane(chance_, lane, laneOf(chance_, lane) + l.stopped[k] * l.worth);
    }
    if (!(sum > 0)) return true;
    double u = several_ ? p.random.uniform() * double{sum} : 0;
    std::size_t k = 0;
    while (k + 1 < scene_.partCount && (u >= double{shares[k]} || !(shares[k] > 0)))
        u -= double{shares[k++]};
    if (!(shares[k] > 0)) return true;
    l.processes.resize(scene_.partCount);
    enter(scene_.parts[numberOf(lane, k)], at, p.direction, 0, l.processes[k]);
    if (l.processes[k].ended) return true;
    l.processes[k].t = 0, l.part = k;
    limit_[lane] = huge;
    put(lane, l.processes[k]);
    scatterIn(lane);
    setLane(w_, lane, scattered[k] * (sum / shares[k]));
    state_[lane] = Arrived;
    ++counters_.collisions;
    return true;
}

/// All is known that a path brings that scatterCameraRay() has begun: corrects it, and adds the
/// light from behind the medium.
template <int N>
void LaneTracer<N>::endCameraPath(std::size_t lane) {
    const Lane& l = lanes_[lane];
    PathState<N, false>& p = pathOf(lane);
    const light::LightSet& lights = traced_.scene.lights;
    const Rgb correction = toRgb(l.correction);
    p.radiance *= correction;
    if (batch_.layers.splitsLight())
        for (Rgb& part : batch_.layers.partsOf(*p.result)) part *= correction;
    if (scene_.chanceLight >= 0)
        bring(batch_, p, toRgb((Spectrum<N>(1.0f) - l.passes) * l.worth) * scene_.chanceUnit,
              image::LightKind::VolumeIndirect, lights.group(scene_.chanceLight));
    p.result->film.alpha = 1 - l.passes.mean();
    for (const int light : lights.distant()) {
        const Rgb radiance = lights.distantRadiance(light, l.cameraDirection, true);
        if (!(radiance.maximum() > 0)) continue;
        const Rgb arrived = toRgb(l.passes) * radiance;
        bring(batch_, p, arrived, image::LightKind::Background, lights.group(light));
        p.result->film.background += arrived;
    }
    if (traced_.options.stoppedLight) noteCameraStops(lane);
}

/// Notes where a camera ray that scatterCameraRay() has drawn has lost its light. What its parts
/// stop at the point adds up to alpha on average. The rest has a mean of zero, wherever it is
/// counted: where half of the depth is.
template <int N>
void LaneTracer<N>::noteCameraStops(std::size_t lane) {
    const Lane& l = lanes_[lane];
    PathState<N, false>& p = pathOf(lane);
    p.direction = l.cameraDirection;
    image::StoppedLight& stopped = *p.result->stopped;
    const CameraDepths::Ray ray = scene_.cameraDepths->at(p.raster[0], p.raster[1]);
    const DepthsAhead<N> ahead(*scene_.cameraDepths, ray, scene_.parts.data());
    Spectrum<N> rest = Spectrum<N>(1.0f) - l.passes;
    double amounts[CameraDepths::mostParts], shares[CameraDepths::mostParts],
        left = double{p.result->film.alpha}, depth = 0;
    for (std::size_t k = 0; k < scene_.partCount; ++k) {
        const Spectrum<N> atPoint = l.stopped[k] * l.correction;
        rest = rest - atPoint;
        left -= amounts[k] = double{atPoint.mean()};
        depth += shares[k] = double{ray.density(scene_.cameraDepths->steps(), k) *
                                    scene_.parts[k].part->largestExtinction()};
    }
    int channel = 0;
    for (int c = 1; c < N; ++c)
        if (ahead.whole()[c] > ahead.whole()[channel]) channel = c;
    const double half = ahead.find(channel, ahead.whole()[channel] / 2);
    const PlanarDepth planar(traced_, p);
    const auto addRest = [&] {
        for (std::size_t k = 0; k < scene_.partCount; ++k)
            addStop(traced_, stopped, planar.at(half), k,
                    left * (depth > 0 ? shares[k] / depth : (k == 0 ? 1.0 : 0.0)));
    };
    const bool atPoint = std::ranges::any_of(std::span(l.stopped).first(scene_.partCount),
                                             [](const auto& s) { return s.maximum() > 0; });
    if (!atPoint || half < l.flightStart) addRest();
    for (std::size_t k = 0; atPoint && k < scene_.partCount; ++k)
        addStop(traced_, stopped, planar.at(l.flightStart), k, amounts[k]);
    if (atPoint && half >= l.flightStart) addRest();
    if (scene_.chanceLight >= 0)
        stopped.arrivals.push_back(
            {planar.at(half), toRgb(rest * l.worth) * scene_.chanceUnit, false});
    stopped.firstEvent = {planar.at(atPoint ? l.flightStart : half), {}, false};
}

}  // namespace woodcock::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
