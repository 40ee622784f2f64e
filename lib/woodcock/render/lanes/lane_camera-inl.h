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

/// Draws where a camera ray scatters, by the depths along it: at several points, each of which the
/// path follows, weighted by what scatters there. The light behind the medium is added for what
/// passes. So no chance decides between the two. False: the ray has no such depths.
///
/// All that the path brings from a point is proportional to the transmittance up to there, which
/// the depths estimate. As in correctedTransmittance(), rare exact integrations correct it: by a
/// factor for the point, see endPoint().
template <int N>
bool LaneTracer<N>::scatterCameraRay(std::size_t lane) {
    Lane& l = lanes_[lane];
    PathState<N, false>& p = pathOf(lane);
    l.fromCamera = scene_.cameraDepths && l.set == 0;
    if (!l.fromCamera) return false;
    l.cameraDirection = p.direction, l.sequence = p.sequence;
    l.worth = Spectrum<N>(), l.passes = Spectrum<N>(1.0f);
    l.point = 0, l.points.clear();
    state_[lane] = Idle;
    double t0 = std::numeric_limits<double>::infinity(), t1 = 0;
    for (std::size_t k = 0; k < scene_.partCount; ++k) {
        const medium::MediumPart& part = *scene_.parts[k].part;
        double enters = 0, leaves = std::numeric_limits<double>::infinity();
        if (grid::clip(part.indexRay(p.origin, p.direction), part.support(), enters, leaves))
            t0 = std::min(t0, enters), t1 = std::max(t1, leaves);
    }
    if (!(t0 < t1)) return true;
    const CameraDepths::Ray ray = scene_.cameraDepths->at(p.raster[0], p.raster[1]);
    const DepthsAhead<N> ahead(*scene_.cameraDepths, ray, scene_.parts.data());
    l.passes = transmittanceOf<N>(ahead.whole()), l.worth = worthOf(p);
    // Of each channel, the share of the points that are drawn by its depth.
    float shares[N], sum = 0;
    for (int c = 0; c < N; ++c)
        sum += shares[c] = -std::expm1(-ahead.whole()[c]) * scene_.cameraAlbedo[c];
    const double even = sum > 0 ? evenPoints : 1;
    const auto drawPoint = [&](double u) {
        if (u < even) return t0 + (t1 - t0) * u / even;
        u = (u - even) / (1 - even) * double{sum};
        int c = 0;
        while (c + 1 < N && u >= double{shares[c]}) u -= double{shares[c++]};
        const auto scattered = std::min(1.0f - 0x1p-24f, static_cast<float>(u / double{shares[c]}));
        return ahead.find(c, -std::log1p(scattered * std::expm1(-ahead.whole()[c])));
    };
    float chance = 0;
    for (int i = 0; i < scene_.points; ++i) {
        const double t = drawPoint((i + p.flight) / scene_.points);
        const typename DepthsAhead<N>::Place place = ahead.at(t);
        double density = t > t0 && t < t1 ? even / (t1 - t0) : 0;
        for (int c = 0; c < N; ++c)
            if (sum > 0)
                density += (1 - even) * double{scene_.cameraAlbedo[c] / sum} *
                           double{place.slope[c]} * std::exp(-double{place.depth[c]});
        chance = std::max(chance, ahead.correctionChance(place.step + 1));
        if (!(density > 0)) continue;
        l.points.push_back({t, transmittanceOf<N>(place.depth),
                            static_cast<float>(1 / (density * scene_.points))});
    }
    std::ranges::sort(l.points, {}, &CameraPoint::t);
    if (p.random.uniform() < double{chance}) correctCameraRay(lane, chance);
    return true;
}

/// Has a path of scatterCameraRay() scatter at the next of its points. False: there is none.
template <int N>
bool LaneTracer<N>::nextPoint(std::size_t lane) {
    Lane& l = lanes_[lane];
    PathState<N, false>& p = pathOf(lane);
    for (; l.point < l.points.size(); ++l.point) {
        p.scatterings = 0, p.alive = true;
        p.direction = l.cameraDirection, p.mediumSet = l.set = 0;
        p.sequence = l.sequence.copy(static_cast<std::uint32_t>(l.point),
                                     static_cast<std::uint32_t>(scene_.points));
        l.first = true, share_[lane] = 1, l.radianceBefore = p.radiance;
        if (batch_.layers.splitsLight() && l.points[l.point].corrected) {
            const auto parts = batch_.layers.partsOf(*p.result);
            l.partsBefore.assign(parts.begin(), parts.end());
        }
        if (scatterAt(lane, l.points[l.point])) return true;
        endPoint(lane);
    }
    return false;
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

/// Integrates a camera ray exactly, up to its points and beyond.
template <int N>
void LaneTracer<N>::correctCameraRay(std::size_t lane, float chance) {
    Lane& l = lanes_[lane];
    const PathState<N, false>& p = pathOf(lane);
    const medium::Medium& medium = traced_.mediumOfSet(0);
    Spectrum<N> depth;
    double from = 0;
    const auto goTo = [&](double t) {
        depth += channels<N>(medium::exactOpticalDepth(medium, p.origin, p.direction, from, t));
        from = t;
    };
    for (CameraPoint& point : l.points) {
        goTo(point.t);
        point.corrected = true;
        for (int c = 0; c < N; ++c)
            point.correction[c] += (std::exp(-depth[c]) / point.passes[c] - 1) / chance;
    }
    goTo(std::numeric_limits<double>::infinity());
    for (int c = 0; c < N; ++c) l.passes[c] += (std::exp(-depth[c]) - l.passes[c]) / chance;
}

/// Puts the lane's path to a point of its camera ray, where it scatters; its throughput becomes
/// the point's weight times the density of the scattering. It scatters nowhere where nothing is
/// there.
template <int N>
bool LaneTracer<N>::scatterAt(std::size_t lane, CameraPoint& point) {
    Lane& l = lanes_[lane];
    PathState<N, false>& p = pathOf(lane);
    const Vec3d at = p.origin + p.direction * point.t;
    const Spectrum<N> weight = point.passes * point.weight;
    Spectrum<N> scattered[CameraDepths::mostParts];
    float shares[CameraDepths::mostParts], sum = 0;
    for (std::size_t k = 0; k < scene_.partCount; ++k) {
        const medium::MediumPart& part = *scene_.parts[k].part;
        const float f = part.field()->trilinear(part.indexRay(at, p.direction).origin);
        scattered[k] = weight * channels<N>(part.scattering()) * f;
        sum += shares[k] = scattered[k].mean();
        point.stopped[k] = weight * channels<N>(part.extinction()) * f;
        setLane(chance_, lane, laneOf(chance_, lane) + point.stopped[k] * l.worth);
    }
    if (!(sum > 0)) return false;
    double u = several_ ? p.random.uniform() * double{sum} : 0;
    std::size_t k = 0;
    while (k + 1 < scene_.partCount && (u >= double{shares[k]} || !(shares[k] > 0)))
        u -= double{shares[k++]};
    if (!(shares[k] > 0)) return false;
    l.processes.resize(scene_.partCount);
    enter(scene_.parts[numberOf(lane, k)], at, l.cameraDirection, 0, l.processes[k]);
    if (l.processes[k].ended) return false;
    l.processes[k].t = 0, l.part = k;
    limit_[lane] = huge;
    for (int i = 0; i < 3; ++i) v_[i][lane] = static_cast<float>(l.cameraDirection[i]);
    put(lane, l.processes[k]);
    scatterIn(lane);
    setLane(w_, lane, scattered[k] * (sum / shares[k]));
    state_[lane] = Arrived;
    ++counters_.collisions;
    return true;
}

/// All is known that a path brings from a point of its camera ray: corrects it.
template <int N>
void LaneTracer<N>::endPoint(std::size_t lane) {
    Lane& l = lanes_[lane];
    PathState<N, false>& p = pathOf(lane);
    bringControls(lane);
    CameraPoint& point = l.points[l.point];
    if (point.corrected) {
        const Rgb correction = toRgb(point.correction);
        p.radiance = l.radianceBefore + (p.radiance - l.radianceBefore) * correction;
        if (batch_.layers.splitsLight()) {
            const std::span<Rgb> parts = batch_.layers.partsOf(*p.result);
            for (std::size_t i = 0; i < parts.size(); ++i)
                parts[i] = l.partsBefore[i] + (parts[i] - l.partsBefore[i]) * correction;
        }
    }
    point.light = p.radiance - l.radianceBefore;
}

/// All is known that a path brings from the points of its camera ray: adds the light from behind
/// the medium.
template <int N>
void LaneTracer<N>::endCameraPath(std::size_t lane) {
    const Lane& l = lanes_[lane];
    PathState<N, false>& p = pathOf(lane);
    const light::LightSet& lights = traced_.scene.lights;
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

/// Notes where a camera ray that scatterCameraRay() has drawn has lost its light, and from where
/// light has come. What its parts stop at the points adds up to alpha on average. The rest has a
/// mean of zero, wherever it is counted: where half of the depth is.
template <int N>
void LaneTracer<N>::noteCameraStops(std::size_t lane) {
    const Lane& l = lanes_[lane];
    PathState<N, false>& p = pathOf(lane);
    p.direction = l.cameraDirection;
    image::StoppedLight& stopped = *p.result->stopped;
    const CameraDepths::Ray ray = scene_.cameraDepths->at(p.raster[0], p.raster[1]);
    const DepthsAhead<N> ahead(*scene_.cameraDepths, ray, scene_.parts.data());
    int channel = 0;
    for (int c = 1; c < N; ++c)
        if (ahead.whole()[c] > ahead.whole()[channel]) channel = c;
    const double half = ahead.find(channel, ahead.whole()[channel] / 2);
    const PlanarDepth planar(traced_, p);
    const Rgb unit = scene_.chanceLight >= 0 ? scene_.chanceUnit : Rgb();
    const auto addArrival = [&](double t, Rgb radiance) {
        if (radiance != Rgb()) stopped.arrivals.push_back({planar.at(t), radiance, false});
    };
    Spectrum<N> rest = Spectrum<N>(1.0f) - l.passes;
    for (const CameraPoint& point : l.points) {
        Spectrum<N> atPoint;
        for (std::size_t k = 0; k < scene_.partCount; ++k)
            atPoint += point.stopped[k] * point.correction;
        rest = rest - atPoint;
        addArrival(point.t, point.light + toRgb(atPoint * l.worth) * unit);
    }
    addArrival(half, toRgb(rest * l.worth) * unit);
    // What glows brings its light later, and then there is one point.
    stopped.firstEvent = {planar.at(l.points.empty() ? half : l.points.front().t), {}, false};
    double depth = 0, shares[CameraDepths::mostParts];
    for (std::size_t k = 0; k < scene_.partCount; ++k)
        depth += shares[k] = double{ray.density(scene_.cameraDepths->steps(), k) *
                                    scene_.parts[k].part->largestExtinction()};
    bool added = false;
    const auto addRestBefore = [&](double t) {
        if (added || half >= t) return;
        added = true;
        for (std::size_t k = 0; k < scene_.partCount; ++k)
            addStop(traced_, stopped, planar.at(half), k,
                    double{rest.mean()} * (depth > 0 ? shares[k] / depth : (k == 0 ? 1.0 : 0.0)));
    };
    for (const CameraPoint& point : l.points) {
        addRestBefore(point.t);
        for (std::size_t k = 0; k < scene_.partCount; ++k)
            addStop(traced_, stopped, planar.at(point.t), k,
                    double{(point.stopped[k] * point.correction).mean()});
    }
    addRestBefore(std::numeric_limits<double>::infinity());
}

}  // namespace woodcock::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
