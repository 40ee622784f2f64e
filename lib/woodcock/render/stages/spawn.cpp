// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/stages/spawn.h"

#include <algorithm>

#include "woodcock/render/stages/camera_layers.h"
#include "woodcock/render/stages/event_numbers.h"
#include "woodcock/render/stages/exact_depths.h"
#include "woodcock/render/stages/light.h"

namespace woodcock::render {

template <int N, bool Surfaces>
void spawn(const TracedScene& traced, Batch<N, Surfaces>& batch, const PathJob& job,
           PathResult& result) {
    const PathTracer::Options& options = traced.options;
    const SampleSequence sequence(options.seed, job.x, job.y, job.sample);
    const auto u = sequence.draw(0);
    const float time = traced.needs.motion ? drawTime(sequence) : 0;
    const camera::CameraRay ray = traced.cameraRays.at(job.x + u[0], job.y + u[1], time);
    result = {};
    batch.paths.push_back(
        {.result = &result,
         .sequence = sequence,
         .random = RandomStream(hashOf(options.seed, 0x70617468, job.x, job.y, job.sample)),
         .origin = ray.origin,
         .direction = ray.direction,
         .raster = {job.x + u[0], job.y + u[1]},
         .time = ray.time,
         .flight = 1 - u[2],
         .mediumSet = traced.media.setAfter(0)});
    const std::size_t i = batch.paths.size() - 1;
    PathState<N, Surfaces>& p = batch.paths[i];
    ++batch.counters.paths;
    if constexpr (Surfaces)
        p.surfaces.way = BoundaryWalk(traced.startOf(p.origin, p.direction, p.time));
    if (options.stoppedLight) result.stopped = std::make_unique<image::StoppedLight>();
    std::ranges::fill(batch.layers.partsOf(result), Rgb());
    if (options.layers.depthSamples()) sampleCameraLayers(traced, p, batch.layers.placeOf(result));
    if (options.layers.stops) batch.layers.stopsOf(result) = findExactDepths(traced, p);
    addLightHits(traced, batch, i, nullptr);
    if (traced.needs.emission) p.equiangular = u[3];
    if (traced.needs.localLights) {
        p.equiangular = u[3];
        p.localLightPick = p.random.uniform();
    }
}

template void spawn(const TracedScene&, Batch<1, false>&, const PathJob&, PathResult&);
template void spawn(const TracedScene&, Batch<1, true>&, const PathJob&, PathResult&);
template void spawn(const TracedScene&, Batch<3, false>&, const PathJob&, PathResult&);
template void spawn(const TracedScene&, Batch<3, true>&, const PathJob&, PathResult&);

}  // namespace woodcock::render
