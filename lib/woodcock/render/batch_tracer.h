// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <vector>

#include "woodcock/medium/features.h"
#include "woodcock/medium/marching.h"
#include "woodcock/medium/phase.h"
#include "woodcock/medium/tracking.h"
#include "woodcock/render/light_choice.h"
#include "woodcock/render/path_state.h"

namespace woodcock::render {

/// N: tracked channels. Surfaces: whether the scene has surfaces; otherwise no code for them is
/// compiled.
template <int N, bool Surfaces>
class BatchTracer final : public PathTracer {
public:
    BatchTracer(const Scene& scene, const Needs& needs, const Options& options)
        : scene_(scene),
          needs_(needs),
          options_(options),
          typicalRadiance_(scene.lights.typicalRadiance(scene.bounds())),
          choice_(scene.lights) {
        gatherMedia();
        if constexpr (Surfaces) {
            nestedMedia_.emplace(scene);
            if (scene.camera.kind == camera::Camera::Kind::Perspective)
                aroundCamera_ =
                    nestedMedia_->cameraPosition(scene.camera.worldFromCamera.translation);
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
            sortByMediumSet();
            for (std::size_t i = 0; i < paths_.size(); ++i) lookAhead(i);
            walk();
            for (std::size_t i = 0; i < paths_.size(); ++i) shade(i);
            shadowWalk();
            retire();
        }
    }

private:
    static constexpr std::size_t batchSize = 256;

    using Path = PathState<N, Surfaces>;

    // ---- stages -------------------------------------------------------------------------------

    void spawn(const PathJob& job, PathResult& result) {
        result = {};
        Path p{.result = &result,
               .sequence = SampleSequence(options_.seed, job.x, job.y, job.sample),
               .random = RandomStream(hashOf(options_.seed, 0x70617468, job.x, job.y, job.sample)),
               .origin = {},
               .direction = {},
               .radiance = {},
               .from = {}};
        const auto u = p.sequence.draw(0);
        const camera::CameraRay ray =
            scene_.camera.ray(job.x + u[0], job.y + u[1], options_.width, options_.height);
        p.origin = ray.origin, p.direction = ray.direction;
        p.flight = 1 - u[2];
        p.mediumSet = mediumSetAfter(0);
        ++counters_.paths;
        if constexpr (Surfaces)
            p.surfaces.start =
                nestedMedia_->rayStart(scene_.camera.kind == camera::Camera::Kind::Perspective
                                           ? aroundCamera_
                                           : nestedMedia_->cameraPosition(p.origin),
                                       p.direction);
        if (options_.depthLayers || options_.featureLayers) findDepth(p);
        paths_.push_back(p);
        const std::size_t i = paths_.size() - 1;
        addSphereHits(i, nullptr);
        if (needs_.emission) paths_[i].equiangular = u[3];
        if (needs_.localLights) {
            paths_[i].equiangular = u[3];
            paths_[i].localLightPick = paths_[i].random.uniform();
        }
    }

    /// Finds what a flight needs before it is tracked: the surface at its end, the emission along
    /// it, and the equiangular point on it.
    void lookAhead(std::size_t i) {
        Path& p = paths_[i];
        if constexpr (Surfaces) {
            SurfaceState& s = p.surfaces;
            s.hitsAhead =
                nestedMedia_->nearest(p.origin, p.direction, infinity, s.start, s.seen, s.ahead);
            s.tMax = s.hitsAhead ? s.ahead.t : infinity;
            ++counters_.surfaceRays;
        }
        if (needs_.emission) addMediumEmission(i, p.equiangular);
        if (needs_.localLights) addEquiangular(i, p.equiangular, p.localLightPick);
    }

    void walk() {
        walks_.clear();
        for (Path& p : paths_)
            walks_.push_back({p.origin, p.direction, flightOf(p).tMax, p.flight, p.random,
                              pathRoulette, false, p.throughput, 0, -1});
        medium::TrackingCounters c;
        if constexpr (Surfaces) {
            for (std::size_t i = 0; i < paths_.size(); ++i) {
                const MediumSummary& medium = *flightOf(paths_[i]).medium;
                if (medium.scatters)
                    findEvents(*medium.medium, {&walks_[i], 1}, c);
                else if (!medium.medium->parts.empty())
                    absorbAlong(medium, walks_[i], paths_[i], c);
            }
        } else {
            forRuns(paths_, [&](const MediumSummary& medium, std::size_t first, std::size_t count) {
                const auto walks = std::span(walks_).subspan(first, count);
                if (medium.scatters)
                    findEvents(*medium.medium, walks, c);
                else
                    for (std::size_t i = 0; i < count; ++i)
                        absorbAlong(medium, walks[i], paths_[first + i], c);
            });
        }
        counters_.distanceSegments += c.segments, counters_.distanceCollisions += c.collisions;
    }

    /// In media that only absorb: the path escapes, weighted by the transmittance.
    void absorbAlong(const MediumSummary& medium, medium::DistanceQuery<N>& walk, Path& p,
                     medium::TrackingCounters& c) const {
        medium::TransmittanceQuery<N> q{walk.origin, walk.direction,  walk.tMax, walk.random,
                                        0,           walk.throughput, seen(p)};
        findTransmittances(*medium.medium, {&q, 1}, c);
        if (seen(p) && options_.approximations.marchStep == 0)
            p.opacity = Spectrum<N>::map(
                [&](int i) { return p.opacity[i] + (1 - p.opacity[i]) * q.opacity[i]; });
        walk.random = q.random, walk.throughput = q.contribution;
    }
    /// Opacity of the media through which the camera's ray has come so far.
    float opacityOf(const Path& p) const {
        const float lost = 1 - p.throughput.mean(), opacity = p.opacity.mean();
        constexpr float rounding = 1e-6f;  // differences up to this are rounding
        return opacity > 0 && std::abs(lost - opacity) < rounding ? opacity : lost;
    }

    void shade(std::size_t i) {
        Path& p = paths_[i];
        const medium::DistanceQuery<N>& w = walks_[i];
        p.random = w.random, p.throughput = w.throughput;
        const bool scattered = w.part >= 0;
        if constexpr (Surfaces) {
            if (!(p.throughput.maximum() > 0)) {
                if (p.surfaces.seen) p.result->film.alpha = 1;
                p.alive = false;
                return;
            }
            if (!scattered && p.surfaces.hitsAhead) {
                meetSurface(i);
                return;
            }
        }
        if (seen(p)) p.result->film.alpha = scattered ? 1 : opacityOf(p);
        if (!(p.throughput.maximum() > 0)) {
            p.alive = false;
        } else if (!scattered) {
            escape(p);
        } else if (options_.maxScatterings && p.scatterings >= *options_.maxScatterings) {
            p.alive = false;
        } else {
            const medium::Medium& medium = *flightOf(p).medium->medium;
            scatter(i, w.t, medium.parts[static_cast<std::size_t>(w.part)].g());
        }
    }

    void shadowWalk() {
        medium::TrackingCounters c;
        counters_.shadowRays += shadows_.size();
        while (!shadows_.empty()) {
            if constexpr (Surfaces)
                for (std::size_t i = 0; i < shadows_.size(); ++i)
                    findShadowAcrossSurfaces(shadows_[i], shadowQueries_[i], c);
            else
                forRuns(shadows_,
                        [&](const MediumSummary& medium, std::size_t first, std::size_t count) {
                            findTransmittances(*medium.medium,
                                               std::span(shadowQueries_).subspan(first, count), c);
                        });
            std::size_t left = 0;
            for (std::size_t i = 0; i < shadows_.size(); ++i) {
                const Spectrum<N> arrived = shadowQueries_[i].contribution;
                if (!(arrived.maximum() > 0)) continue;
                ShadowRay<Surfaces> s = shadows_[i];
                if (!s.secondLeg) {
                    Path& p = paths_[s.path];
                    (s.inFront ? p.result->film.radiance : p.radiance) += s.colour * toRgb(arrived);
                    continue;
                }
                s.secondLeg = false, s.mediumSet = s.secondMediumSet;
                medium::TransmittanceQuery<N> q = shadowQueries_[i];
                q.origin = s.origin, q.direction = s.direction, q.tMax = s.tMax;
                if constexpr (Surfaces) s.start.left.reset();
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
            p.result->film.events = static_cast<float>(p.scatterings);
            if constexpr (Surfaces) p.result->film.events += static_cast<float>(p.surfaces.bounces);
            if (p.result->catcher.weight > 0)
                p.result->catcher.lit = p.radiance.mean();
            else
                p.result->film.radiance += p.radiance;
            clampRadiance(p.result->film);
        }
        paths_.resize(left, paths_.front());
    }

    // ---- the two inner loops: by tracking, or by marching where that was chosen

    void findEvents(const medium::Medium& medium, std::span<medium::DistanceQuery<N>> queries,
                    medium::TrackingCounters& c) const {
        if (options_.approximations.marchStep > 0)
            medium::marchDistance<N>(medium, marchSettings(options_.approximations), queries, c);
        else
            medium::trackDistance<N>(medium, queries, c);
    }
    void findTransmittances(const medium::Medium& medium,
                            std::span<medium::TransmittanceQuery<N>> queries,
                            medium::TrackingCounters& c) const {
        if (options_.approximations.marchStep > 0)
            medium::marchTransmittance<N>(medium, marchSettings(options_.approximations), queries,
                                          c);
        else
            medium::trackTransmittance<N>(medium, queries, c);
    }

    // ---- events in media: batch_tracer_media.h

    /// Adds radiance from infinity. Images and discs are shared with next-event estimation.
    void escape(Path& p);
    void scatter(std::size_t i, double t, double g);
    EventNumbers numbers(Path& p);

    // ---- approximate media: batch_tracer_approximate_media.h

    /// The scene's media, and the sets of media that approximations use in their place.
    void gatherMedia();
    /// Paths in approximate media first, so that runs of one medium are long.
    void sortByMediumSet();
    /// Calls f(medium, first, count) for each run of paths or shadow rays in one medium; only
    /// without surfaces.
    template <class Items, class F>
    void forRuns(const Items& items, F&& f) const;
    /// The set of media for a path that has scattered so often, and the index in media_ of the
    /// medium that surrounds it.
    std::uint8_t mediumSetAfter(std::int64_t scatterings) const;
    std::uint32_t mediumIndex(std::uint8_t mediumSet, const MediumStack& inside) const;
    /// How a path goes on after its next scattering: through which set of media, with g times
    /// `phase`, and with the scattered light times `amount`.
    struct Onward {
        std::uint8_t mediumSet;
        double amount = 1, phase = 1;
    };
    Onward onwardFrom(Path& p) const;
    /// Makes the path go on so, and returns Onward::phase.
    double enterMediumSet(Path& p) const;
    void clampRadiance(image::FilmSample& sample);

    // ---- events on surfaces: batch_tracer_surfaces.h; light: batch_tracer_light.h
    void meetSurface(std::size_t i);
    void bounce(std::size_t i, const surface::SurfaceHit& hit, const Crossing& crossing);
    SurfaceState::LightSampled lightSampledAfter(SurfaceState::LightSampled before,
                                                 const surface::Bsdf& bsdf,
                                                 const surface::BsdfSample& b) const;
    /// Goes on behind a boundary that changes only the medium.
    void goOn(Path& p);
    void addEmission(Path& p, const surface::SurfaceHit& hit, const surface::Bsdf& bsdf);
    /// Next-event estimation at a surface.
    void lightSurface(std::size_t i, const EventNumbers& u, const surface::SurfaceHit& hit,
                      const Crossing& crossing, Vec3d out, bool caught);
    /// For shadow catchers: adds the unoccluded light, from the direction that was drawn, of lights
    /// that next-event estimation leaves out.
    void addUnoccluded(Path& p);
    void playRoulette(Path& p);
    /// Follows a shadow ray through boundaries that light passes, to its end or to the first
    /// surface that stops it.
    void findShadowAcrossSurfaces(ShadowRay<Surfaces>& shadow, medium::TransmittanceQuery<N>& q,
                                  medium::TrackingCounters& c);
    bool arrives(const ShadowRay<Surfaces>& shadow, const surface::SurfaceHit& hit,
                 double left) const;
    /// The transmittance of camera rays, and the first thing that they meet, by a separate walk.
    void findDepth(const Path& p);
    void addNextEvent(std::size_t i, const EventNumbers& u, const FlightShare& share);
    /// Adds sphere lights that the new direction hits, with the weight of multiple importance
    /// sampling that next-event estimation leaves. Where `share` is null, the camera sees them.
    void addSphereHits(std::size_t i, const FlightShare* share);
    void addEquiangular(std::size_t i, double u, double pick);
    /// Adds the light that media emit along the flight ahead, by one random point of it.
    void addMediumEmission(std::size_t i, double u);
    /// Adds a shadow ray that brings `light` times the path's throughput, unless that is zero.
    /// `mayPass`: transparent shadows apply to it.
    bool addShadowRay(std::size_t i, Vec3d origin, Vec3d direction, double tMax, Rgb light,
                      bool mayPass);

    /// The weight, by multiple importance sampling, of light that a path hits. pdf(): the density
    /// with which next-event estimation at the last event would have sampled it.
    template <class F>
    double hitWeight(const Path& p, F&& pdf) {
        if constexpr (Surfaces) {
            using enum SurfaceState::LightSampled;
            if (p.surfaces.lightSampled == Never) return 1;
            if (p.surfaces.lightSampled == ThroughDielectrics) return pdf() > 0 ? 0 : 1;
        } else {
            if (p.scatterings == 0) return 1;
        }
        return powerHeuristic(p.phasePdf, pdf());
    }
    std::optional<Vec3d> localLightPosition(int light) const {
        const light::Light& l = scene_.lights.lights()[static_cast<std::size_t>(light)];
        if (const auto* point = std::get_if<light::PointLight>(&l)) return point->position;
        if (const auto* sphere = std::get_if<light::SphereLight>(&l)) return sphere->position;
        return {};
    }

    // ---- the path's state ---------------------------------------------------------------------

    /// True while the camera's ray has not scattered.
    static bool seen(const Path& p) {
        if constexpr (Surfaces)
            return p.surfaces.seen;
        else
            return p.scatterings == 0;
    }
    Flight flightOf(const Path& p) const {
        if constexpr (Surfaces)
            return {p.origin, p.direction, p.surfaces.tMax,
                    &media_[mediumIndex(p.mediumSet, p.surfaces.start.inside)]};
        else
            return {p.origin, p.direction, infinity, &media_[p.mediumSet]};
    }
    /// True outside of all surfaces, in a medium that fills all of space.
    bool inEndlessMedium(const Path& p) const {
        if (!flightOf(p).medium->unbounded) return false;
        if constexpr (Surfaces) return nestedMedia_->medium(p.surfaces.start.inside) == 0;
        return true;
    }
    static Rgb tint(const Path& p) {
        if constexpr (Surfaces)
            return p.surfaces.tint;
        else
            return Rgb(1.0f);
    }
    /// Weights the path by a surface's colour: in its throughput where three channels are tracked,
    /// else in its tint.
    static void multiply(Path& p, Rgb weight) {
        if constexpr (N == 3)
            p.throughput *= weight;
        else
            p.surfaces.tint *= weight;
    }
    static float brightness(const Path& p) {
        return (toRgb(p.throughput) * p.surfaces.tint).maximum();
    }
    static Rgb toRgb(Spectrum<N> s) {
        return Rgb::map([&](int c) { return s[N == 1 ? 0 : c]; });
    }

    struct Piece {
        Vec3d origin;
        double length;
        std::uint32_t medium;
    };

    const Scene& scene_;
    const Needs needs_;
    const Options options_;
    const float typicalRadiance_;
    std::vector<MediumSummary> media_;  // set by set; in each the outside, then what surfaces hold
    bool replacesMedia_ = false;        // there are approximate media
    bool octavesEnd_ =
        false;  // octaves end with next-event estimation: their flights meet no light
    LightChoice choice_;
    medium::EmissionSampler emission_;
    RenderCounters counters_;
    std::vector<Path> paths_;
    std::vector<medium::DistanceQuery<N>> walks_;
    std::vector<ShadowRay<Surfaces>> shadows_;
    std::vector<medium::TransmittanceQuery<N>> shadowQueries_;
    // Where there are surfaces:
    std::optional<NestedMedia> nestedMedia_;
    NestedMedia::CameraPosition aroundCamera_;
    std::vector<Piece> pieces_;  // of one shadow ray
};

}  // namespace woodcock::render

#include "woodcock/render/batch_tracer_approximate_media.h"
#include "woodcock/render/batch_tracer_light.h"
#include "woodcock/render/batch_tracer_media.h"
#include "woodcock/render/batch_tracer_surfaces.h"
