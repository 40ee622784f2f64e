// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/path_tracer.h"

#include <algorithm>
#include <vector>

#include "woodcock/base/sample_sequence.h"
#include "woodcock/medium/phase.h"
#include "woodcock/medium/tracking.h"
#include "woodcock/render/equiangular.h"

namespace woodcock {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Throughput below which paths play Russian roulette (absorption is a weight).
constexpr float pathRoulette = 0.1f;
/// Shadow rays play it below this part of the radiance that the scene's lights typically make.
constexpr float shadowRoulette = 0.05f;
/// Scattering orders whose numbers come from the quasi-random sequence.
constexpr int quasiRandomOrders = 4;
/// From this order on, every doubling of the order is survived with probability 1/sqrt(2): in a
/// conservative medium the number of scatterings has a tail like n^(-1/2), for which both cost and
/// variance then grow like log n.
constexpr int firstOrderRoulette = 4096;

/// Power heuristic of two sampling densities: Veach 1997, eq. 9.13.
double powerHeuristic(double own, double other) {
    if (!(own > 0)) return 0;
    const double r = other / own;
    return 1 / (1 + r * r);
}

/// The random numbers of one scattering event and of the flight after it.
struct EventNumbers {
    std::array<double, 2> phase, light;
    double flight, pick, equiangular;
};

template <int N>
class BatchTracer final : public PathTracer {
public:
    BatchTracer(const Scene& scene, const Needs& needs, const Options& options)
        : scene_(scene),
          needs_(needs),
          options_(options),
          bounds_(scene.medium.worldBounds()),
          typicalRadiance_(scene.lights.typicalRadiance(bounds_)),
          pick_(scene.lights.sampled().size()) {
        for (const MediumPart& p : scene.medium.parts) {
            meanExtinction_ += p.meanExtinction();
            unbounded_ |= p.unbounded();
        }
    }

    const RenderCounters& counters() const override { return counters_; }

    bool trace(std::span<const PathJob> jobs, std::span<PathResult> results,
               const std::function<bool()>& stop) override {
        paths_.clear(), walks_.clear();
        std::size_t next = 0;
        while (true) {
            if (stop()) return false;
            while (paths_.size() < batchSize && next < jobs.size()) {
                spawn(jobs[next], results[next]);
                ++next;
            }
            if (paths_.empty()) return true;
            walk();
            for (std::size_t i = 0; i < paths_.size(); ++i) shade(i);
            shadowWalk();
            retire();
        }
    }

private:
    static constexpr std::size_t batchSize = 256;

    struct Path {
        PathResult* result;
        SampleSequence sequence;
        RandomStream random;
        Vec3d origin, direction;
        Spectrum<N> throughput{1.0f};
        Rgb radiance;
        std::int64_t scatterings = 0;
        ScatterPoint from;    // the last scattering event, for MIS at what its direction hits
        double phasePdf = 0;  // of that direction
        double flight = 1;    // draws the next optical depth
        bool alive = true;
    };
    /// A query of light along one or two straight legs, and the path that it lights. The medium's
    /// channels travel in the query; the light's colour, largest channel 1, waits here.
    struct ShadowRay {
        std::size_t path;
        Rgb colour;
        bool secondLeg = false;
        Vec3d origin, direction;  // of the second leg
        double tMax = 0;
    };

    // ---- stages -------------------------------------------------------------------------------

    void spawn(const PathJob& job, PathResult& result) {
        result = {};
        Path p{&result,
               SampleSequence(options_.seed, job.x, job.y, job.sample),
               RandomStream(hashOf(options_.seed, 0x70617468, job.x, job.y, job.sample)),
               {},
               {},
               Spectrum<N>(1.0f),
               {},
               0,
               {},
               0,
               1,
               true};
        const auto u = p.sequence.draw(0);
        const CameraRay ray =
            scene_.camera.ray(job.x + u[0], job.y + u[1], options_.width, options_.height);
        p.origin = ray.origin, p.direction = ray.direction;
        p.flight = 1 - u[2];
        ++counters_.paths;
        if (options_.depthLayers) findDepth(p);
        paths_.push_back(p);
        const std::size_t i = paths_.size() - 1;
        addSphereHits(i, 1, nullptr);
        if (needs_.localLights) addEquiangular(i, u[3], paths_[i].random.uniform());
    }

    void walk() {
        walks_.clear();
        if (!needs_.scattering) {
            absorb();
            return;
        }
        for (Path& p : paths_)
            walks_.push_back({p.origin, p.direction, infinity, p.flight, p.random, pathRoulette,
                              false, p.throughput, 0, -1});
        TrackingCounters c;
        trackDistance<N>(scene_.medium, walks_, c);
        counters_.distanceSegments += c.segments, counters_.distanceCollisions += c.collisions;
    }

    /// The short way of media that only absorb: every path escapes, with its transmittance.
    void absorb() {
        TrackingCounters c;
        for (Path& p : paths_) {
            TransmittanceQuery<N> q{p.origin, p.direction, infinity, p.random, 0, p.throughput};
            trackTransmittance<N>(scene_.medium, {&q, 1}, c);
            walks_.push_back({p.origin, p.direction, infinity, p.flight, q.random, 0, false,
                              q.contribution, 0, -1});
        }
        counters_.distanceSegments += c.segments, counters_.distanceCollisions += c.collisions;
    }

    void shade(std::size_t i) {
        Path& p = paths_[i];
        const DistanceQuery<N>& w = walks_[i];
        p.random = w.random, p.throughput = w.throughput;
        const bool scattered = w.part >= 0;
        if (p.scatterings == 0) p.result->film.alpha = scattered ? 1 : 1 - p.throughput.mean();
        if (!(p.throughput.maximum() > 0)) {
            p.alive = false;
        } else if (!scattered) {
            escape(p);
        } else if (options_.maxScatterings && p.scatterings >= *options_.maxScatterings) {
            p.alive = false;
        } else {
            scatter(i, w.t, scene_.medium.parts[static_cast<std::size_t>(w.part)].g());
        }
    }

    void shadowWalk() {
        TrackingCounters c;
        counters_.shadowRays += shadows_.size();
        while (!shadows_.empty()) {
            trackTransmittance<N>(scene_.medium, shadowQueries_, c);
            std::size_t left = 0;
            for (std::size_t i = 0; i < shadows_.size(); ++i) {
                const Spectrum<N> arrived = shadowQueries_[i].contribution;
                if (!(arrived.maximum() > 0)) continue;
                ShadowRay s = shadows_[i];
                if (!s.secondLeg) {
                    paths_[s.path].radiance += s.colour * toRgb(arrived);
                    continue;
                }
                s.secondLeg = false;
                TransmittanceQuery<N> q = shadowQueries_[i];
                q.origin = s.origin, q.direction = s.direction, q.tMax = s.tMax;
                shadows_[left] = s, shadowQueries_[left] = q, ++left;
            }
            shadows_.resize(left), shadowQueries_.resize(left);
        }
        counters_.shadowSegments += c.segments, counters_.shadowCollisions += c.collisions;
    }

    void retire() {
        std::size_t left = 0;
        for (Path& p : paths_) {
            if (p.alive) {
                paths_[left++] = p;
                continue;
            }
            p.result->film.radiance = p.radiance;
        }
        paths_.resize(left, paths_.front());
    }

    // ---- events -------------------------------------------------------------------------------

    /// Radiance from infinity; next-event estimation has a share in images and discs.
    void escape(Path& p) {
        p.alive = false;
        const bool camera = p.scatterings == 0;
        for (std::size_t i = 0; i < scene_.lights.lights().size(); ++i) {
            const Rgb radiance =
                scene_.lights.distantRadiance(static_cast<int>(i), p.direction, camera);
            if (!(radiance.maximum() > 0)) continue;
            const double weight =
                camera ? 1
                       : powerHeuristic(p.phasePdf,
                                        lightPdf(static_cast<int>(i), p.from, p.direction));
            p.radiance += toRgb(p.throughput) * radiance * static_cast<float>(weight);
        }
    }

    void scatter(std::size_t i, double t, double g) {
        Path& p = paths_[i];
        ++counters_.scatterings;
        const Vec3d position = p.origin + p.direction * t;
        const EventNumbers u = numbers(p);
        // What equiangular sampling of this flight leaves to this event; see addEquiangular.
        const FlightShare share{this, p.origin, p.direction, t};
        p.from = {position, p.direction, g};
        if (needs_.lightSampling) addNextEvent(i, u, share);

        const PhaseSample s = sampleHenyeyGreenstein(p.direction, g, u.phase[0], u.phase[1]);
        p.origin = position, p.direction = s.direction, p.phasePdf = s.pdf;
        p.flight = u.flight;
        ++p.scatterings;
        addSphereHits(i, s.pdf, &share);
        if (p.scatterings >= firstOrderRoulette &&
            std::has_single_bit(static_cast<std::uint64_t>(p.scatterings))) {
            if (p.random.uniform() >= 0.70710678118654752) {
                p.alive = false;
                return;
            }
            p.throughput *= 1.41421356f;
        }
        if (needs_.localLights) addEquiangular(i, u.equiangular, u.pick);
    }

    EventNumbers numbers(Path& p) {
        if (p.scatterings >= quasiRandomOrders) {
            auto& r = p.random;
            return {{r.uniform(), r.uniform()},
                    {r.uniform(), r.uniform()},
                    r.uniformOpenLow(),
                    r.uniform(),
                    r.uniform()};
        }
        const auto set = static_cast<std::uint32_t>(2 * p.scatterings + 1);
        const auto a = p.sequence.draw(set), b = p.sequence.draw(set + 1);
        return {{a[0], a[1]}, {a[2], a[3]}, 1 - b[0], b[1], b[2]};
    }

    /// Camera rays' transmittance and the distance of what they meet, by a walk of their own.
    void findDepth(const Path& p) {
        DistanceQuery<N> q{p.origin,
                           p.direction,
                           infinity,
                           p.flight,
                           RandomStream(RandomStream(p.random).bits()),
                           0,
                           true,
                           Spectrum<N>(1.0f),
                           0,
                           -1};
        TrackingCounters c;
        trackDistance<N>(scene_.medium, {&q, 1}, c);
        const float weight = q.throughput.mean();
        if (q.part >= 0)
            p.result->depth = {{}, weight * static_cast<float>(q.t), weight};
        else
            p.result->depth.transmittance = toRgb(q.throughput);
    }

    // ---- light --------------------------------------------------------------------------------

    /// Density, per steradian, with which next-event estimation at `from` would pick this direction
    /// towards this light.
    double lightPdf(int light, const ScatterPoint& from, Vec3d direction) {
        const double pdf = scene_.lights.pdf(light, from.position, direction);
        if (!(pdf > 0)) return 0;
        const auto sampled = scene_.lights.sampled();
        scene_.lights.pickProbabilities(from, pick_);
        for (std::size_t i = 0; i < sampled.size(); ++i)
            if (sampled[i] == light) return pdf * pick_[i];
        return 0;
    }

    /// Splits a local light's direct light between the event that distance sampling found on a
    /// flight and the point that equiangular sampling chose on it: the balance heuristic with a
    /// homogeneous stand-in for the density of the former, which null-collision tracking does not
    /// know. Both sides use the same formula, so the sum is unbiased whatever its quality.
    struct FlightShare {
        const BatchTracer* tracer;
        Vec3d origin, direction;
        double t;
        /// The event's part of light from a lamp at `position`.
        double operator()(Vec3d position) const {
            if (!tracer->needs_.localLights) return 1;
            const Equiangular e = tracer->equiangular(origin, direction, position);
            const double other = e.pdf(t);
            const double own = tracer->flightDensity(e, t);
            return own + other > 0 ? own / (own + other) : 1;
        }
    };

    std::optional<Vec3d> lampPosition(int light) const {
        const Light& l = scene_.lights.lights()[static_cast<std::size_t>(light)];
        if (const auto* point = std::get_if<PointLight>(&l)) return point->position;
        if (const auto* sphere = std::get_if<SphereLight>(&l)) return sphere->position;
        return {};
    }

    void addNextEvent(std::size_t i, const EventNumbers& u, const FlightShare& share) {
        Path& p = paths_[i];
        const auto sampled = scene_.lights.sampled();
        scene_.lights.pickProbabilities(p.from, pick_);
        double rest = u.pick;
        std::size_t k = 0;
        while (k + 1 < sampled.size() && rest >= pick_[k]) rest -= pick_[k++];
        if (!(pick_[k] > 0)) return;
        const LightSample s =
            scene_.lights.sample(sampled[k], p.from.position, u.light[0], u.light[1]);
        if (!(s.weight.maximum() > 0)) return;
        const double phase = henyeyGreenstein(dot(p.from.forward, s.direction), p.from.g);
        double weight = phase / pick_[k];
        if (s.pdf > 0) weight *= powerHeuristic(s.pdf * pick_[k], phase);
        if (const auto lamp = lampPosition(sampled[k])) weight *= share(*lamp);
        addShadowRay(i, p.from.position, s.direction, s.distance,
                     s.weight * static_cast<float>(weight));
    }

    /// Sphere lights that the new direction hits: the other side of next-event estimation's MIS.
    /// Without a scattering event (`share` null) it is the camera that sees them.
    void addSphereHits(std::size_t i, double pdf, const FlightShare* share) {
        for (int light : scene_.lights.local()) {
            const auto* sphere =
                std::get_if<SphereLight>(&scene_.lights.lights()[static_cast<std::size_t>(light)]);
            if (!sphere || (!share && !sphere->visible)) continue;
            const Path& p = paths_[i];
            const double t = sphere->hit(p.origin, p.direction);
            if (!std::isfinite(t)) continue;
            double weight = 1;
            if (share)
                weight = powerHeuristic(pdf, lightPdf(light, p.from, p.direction)) *
                         (*share)(sphere->position);
            addShadowRay(i, p.origin, p.direction, t,
                         sphere->radiance * static_cast<float>(weight));
        }
    }

    Equiangular equiangular(Vec3d origin, Vec3d direction, Vec3d lamp) const {
        double t0 = 0, t1 = infinity;
        if (!unbounded_ && !clip({origin, direction}, bounds_, t0, t1)) return {};
        return {origin, direction, lamp, t0, t1, length(bounds_.size()) * 1e-9};
    }
    double flightDensity(const Equiangular& e, double t) const {
        return meanExtinction_ * std::exp(-meanExtinction_ * std::max(0.0, t - e.t0()));
    }

    void addEquiangular(std::size_t i, double u, double pick) {
        const Path& p = paths_[i];
        if (options_.maxScatterings && p.scatterings >= *options_.maxScatterings) return;
        const auto lamps = scene_.lights.local();
        const double scaled = pick * static_cast<double>(lamps.size());
        const int light = lamps[std::min(static_cast<std::size_t>(scaled), lamps.size() - 1)];
        const Vec3d lamp = *lampPosition(light);
        const Equiangular e = equiangular(p.origin, p.direction, lamp);
        const double t = e.sample(u), pdf = e.pdf(t);
        if (!(pdf > 0)) return;
        const ScatterPoint at{p.origin + p.direction * t, p.direction, 0};
        const double lightU = scaled - std::floor(scaled);
        const LightSample s =
            scene_.lights.sample(light, at.position, lightU, paths_[i].random.uniform());
        if (!(s.weight.maximum() > 0)) return;
        Rgb scattered;  // sum over parts of sigma_s x phase
        for (const MediumPart& part : scene_.medium.parts)
            scattered += part.sigmaS(at.position) * static_cast<float>(henyeyGreenstein(
                                                        dot(at.forward, s.direction), part.g()));
        // Balance heuristic against the event, over the density of this point and lamp.
        const double weight = static_cast<double>(lamps.size()) / (pdf + flightDensity(e, t));
        if (!addShadowRay(i, p.origin, p.direction, t,
                          scattered * s.weight * static_cast<float>(weight)))
            return;
        ShadowRay& ray = shadows_.back();
        ray.secondLeg = true;
        ray.origin = at.position, ray.direction = s.direction, ray.tMax = s.distance;
    }

    /// Adds a shadow ray that brings `light` times the path's throughput, unless that is nothing.
    bool addShadowRay(std::size_t i, Vec3d origin, Vec3d direction, double tMax, Rgb light) {
        Path& p = paths_[i];
        const float brightest = light.maximum();
        const Spectrum<N> contribution = p.throughput * brightest;
        if (!(contribution.maximum() > 0)) return false;
        shadows_.push_back({i, light * (1 / brightest), false, {}, {}, 0});
        shadowQueries_.push_back({origin, direction, tMax, RandomStream(p.random.bits()),
                                  shadowRoulette * typicalRadiance_, contribution});
        return true;
    }

    static Rgb toRgb(Spectrum<N> s) {
        return Rgb::map([&](int c) { return s[N == 1 ? 0 : c]; });
    }

    const Scene& scene_;
    const Needs needs_;
    const Options options_;
    const Box3d bounds_;
    const float typicalRadiance_;
    double meanExtinction_ = 0;
    bool unbounded_ = false;
    RenderCounters counters_;
    std::vector<Path> paths_;
    std::vector<DistanceQuery<N>> walks_;
    std::vector<ShadowRay> shadows_;
    std::vector<TransmittanceQuery<N>> shadowQueries_;
    std::vector<float> pick_;
};

}  // namespace

std::unique_ptr<PathTracer> PathTracer::make(const Scene& scene, const Needs& needs,
                                             const Options& options) {
    if (needs.chromatic) return std::make_unique<BatchTracer<3>>(scene, needs, options);
    return std::make_unique<BatchTracer<1>>(scene, needs, options);
}

}  // namespace woodcock
