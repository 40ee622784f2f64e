// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/path_tracer.h"

#include "woodcock/render/batch.h"
#include "woodcock/render/empty_pixels.h"
#include "woodcock/render/lanes/trace_lanes.h"
#include "woodcock/render/stages/camera_stops.h"
#include "woodcock/render/stages/light.h"
#include "woodcock/render/stages/look_ahead.h"
#include "woodcock/render/stages/retire.h"
#include "woodcock/render/stages/shade_media.h"
#include "woodcock/render/stages/shade_surfaces.h"
#include "woodcock/render/stages/shadow_walk.h"
#include "woodcock/render/stages/spawn.h"
#include "woodcock/render/stages/walk.h"
#include "woodcock/render/traced_scene.h"

// The whole of a path, from the camera until it is handed in.
//
//   spawn         gives it a camera ray, its random numbers and its time
//   look ahead    finds the surface that ends its flight; samples what glows and the local lights
//                 along it
//   walk          finds where it scatters within the flight, if it does
//   shade         ends it, or gives it a new direction where it scattered or met a surface, and
//                 samples a light from there
//   shadow walk   follows all rays to lights that the stages before have added
//   retire        hands in what it found, once it has ended
//
// Each stage takes the whole batch, and is a file of `stages/`. A batch is plain values: paths, the
// queries of the two walks, and shadow rays. The walks sort their queries into runs of one medium;
// they know nothing of lights, materials or film. Every path has random numbers of its own. So the
// order within a batch, and what else is in it, changes no result.
//
// Where a scene is made of standing media, what they emit, suns and environments alone, `lanes/`
// takes the place of the three stages in the middle: it traces all paths of the batch to their
// ends.

namespace woodcock::render {

namespace {

/// What a path's flight came to.
enum class FlightEnd {
    Lost,       ///< absorption, or roulette, has taken all
    Scatters,   ///< in a medium
    AtSurface,  ///< at the surface ahead
    Escapes     ///< beyond everything
};

template <int N, bool Surfaces>
FlightEnd endOf(const PathState<N, Surfaces>& p, const medium::DistanceQuery<N>& walk) {
    if (!(p.throughput.maximum() > 0)) return FlightEnd::Lost;
    if (walk.part >= 0) return FlightEnd::Scatters;
    if constexpr (Surfaces)
        if (p.surfaces.way.meets()) return FlightEnd::AtSurface;
    return FlightEnd::Escapes;
}

/// N: tracked channels. Surfaces: whether the scene has surfaces; otherwise no code for them is
/// compiled.
template <int N, bool Surfaces>
class BatchTracer final : public PathTracer {
public:
    BatchTracer(const Scene& scene, const Needs& needs, const Options& options)
        : traced_(scene, needs, options),
          lanes_(Surfaces ? std::nullopt : LaneScene::make(traced_)),
          batch_(scene.lights) {}

    bool trace(std::span<const PathJob> jobs, std::span<PathResult> results,
               const PathLayers& layers, const std::function<bool()>& stop,
               RenderCounters& counters) override {
        batch_.clear();
        batch_.layers = LayerOutput(traced_.options.layers.parts, results, layers);
        std::size_t next = 0;
        while (true) {
            if (stop()) return false;
            const EmptyPixels* const empty = traced_.options.emptyPixels;
            const std::size_t size = lanes_ ? batch_.laneSize : batch_.size;
            for (; batch_.paths.size() < size && next < jobs.size(); ++next) {
                if (empty && empty->holds(jobs[next].x, jobs[next].y)) {
                    results[next] = {};
                    results[next].film = empty->sample();
                    ++batch_.counters.paths;
                } else {
                    spawn(traced_, batch_, jobs[next], results[next]);
                }
            }
            if (batch_.paths.empty()) break;
            if (lanes_) {
                if constexpr (!Surfaces) traceLanes(*lanes_, batch_);
            } else {
                lookAhead(traced_, batch_);
                walk(traced_, batch_);
                for (std::size_t i = 0; i < batch_.paths.size(); ++i) shade(i);
            }
            shadowWalk(traced_, batch_);
            retire(traced_, batch_);
        }
        counters += batch_.counters;
        return true;
    }

private:
    void shade(std::size_t i) {
        PathState<N, Surfaces>& p = batch_.paths[i];
        const medium::DistanceQuery<N>& walk = batch_.walks[i];
        p.random = walk.random, p.throughput = walk.throughput;
        const FlightEnd end = endOf(p, walk);
        const bool scattered = walk.part >= 0;
        if (seen(p) && end != FlightEnd::AtSurface)
            p.result->film.alpha = scattered ? 1 : opacityOf(p);
        if (scattered && isToBeNoted(traced_, p)) noteFirstScattering(traced_, p, walk.t);
        switch (end) {
            case FlightEnd::Lost:
                p.alive = false;
                break;
            case FlightEnd::Scatters:
                if (traced_.mayScatter(p.scatterings))
                    scatter(traced_, batch_, i, walk.t, static_cast<std::size_t>(walk.part));
                else
                    p.alive = false;
                break;
            case FlightEnd::AtSurface:
                if constexpr (Surfaces) meetSurface(traced_, batch_, i);
                break;
            case FlightEnd::Escapes:
                escape(traced_, batch_, p);
                break;
        }
    }

    const TracedScene traced_;
    const std::optional<LaneScene> lanes_;  // where paths are traced in lanes
    Batch<N, Surfaces> batch_;
};

template <int N>
std::unique_ptr<PathTracer> makeFor(const Scene& scene, const Needs& needs,
                                    const PathTracer::Options& options) {
    if (needs.surfaces) return std::make_unique<BatchTracer<N, true>>(scene, needs, options);
    return std::make_unique<BatchTracer<N, false>>(scene, needs, options);
}

}  // namespace

std::unique_ptr<PathTracer> PathTracer::make(const Scene& scene, const Needs& needs,
                                             const Options& options) {
    return needs.chromatic ? makeFor<3>(scene, needs, options) : makeFor<1>(scene, needs, options);
}

}  // namespace woodcock::render
