// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/support/small_pictures.h"

#include <vector>

#include "woodcock/base/random.h"
#include "woodcock/render/lanes/lane_scene.h"
#include "woodcock/render/path_tracer.h"

namespace woodcock::proof {

namespace {

render::PathTracer::Options optionsOf(const SmallPicture& picture) {
    render::PathTracer::Options options;
    options.width = options.height = picture.side;
    options.maxScatterings = picture.maxScatterings;
    options.lanes = picture.lanes, options.lightDepths = picture.lightDepths;
    options.cameraDepths = picture.cameraDepths;
    options.radiance = picture.radiance;
    return options;
}

}  // namespace

SmallPictureMeans meansOf(const render::Scene& scene, const SmallPicture& picture,
                          std::uint64_t firstSeed, int seeds) {
    const int side = picture.side;
    std::vector<render::PathJob> jobs;
    for (int pixel = 0; pixel < side * side; ++pixel)
        for (int sample = 0; sample < picture.samples; ++sample)
            jobs.push_back({pixel % side, pixel / side, static_cast<std::uint32_t>(sample)});
    std::vector<render::PathResult> results(jobs.size());
    render::PathTracer::Options options = optionsOf(picture);
    SmallPictureMeans means;
    for (int i = 0; i < seeds; ++i) {
        options.seed = hashOf(firstSeed, i);
        const auto tracer = render::PathTracer::make(scene, render::findNeeds(scene), options);
        render::RenderCounters counters;
        tracer->trace(
            jobs, results, [] { return false; }, counters);
        double sums[3]{}, quarters[4]{}, alpha = 0;
        for (std::size_t k = 0; k < jobs.size(); ++k) {
            const image::FilmSample& film = results[k].film;
            for (int c = 0; c < 3; ++c) sums[c] += double{film.radiance[c]};
            quarters[jobs[k].y * 2 / side * 2 + jobs[k].x * 2 / side] += double{film.radiance[1]};
            alpha += double{film.alpha};
        }
        const double share = 1 / static_cast<double>(jobs.size());
        for (std::size_t c = 0; c < 3; ++c) means.radiance[c].add(sums[c] * share);
        for (std::size_t q = 0; q < 4; ++q) means.quarters[q].add(quarters[q] * share * 4);
        means.alpha.add(alpha * share);
    }
    return means;
}

bool inLanes(const render::Scene& scene, const SmallPicture& picture) {
    const render::TracedScene traced(scene, render::findNeeds(scene), optionsOf(picture));
    return render::LaneScene::make(traced).has_value();
}

}  // namespace woodcock::proof
