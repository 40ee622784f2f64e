// SPDX-License-Identifier: Apache-2.0
#include "tools/common/stats.h"

#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "tools/common/progress.h"
#include "woodcock/base/version.h"

namespace woodcock::tool {

std::uint64_t peakMemoryBytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts kilobytes
}

nlohmann::ordered_json statsJson(const render::RenderResult& result,
                                 const render::RenderSettings& settings,
                                 const std::string& sceneDigest, double loadSeconds,
                                 const std::vector<std::filesystem::path>& files) {
    std::vector<std::string> names;
    for (const std::filesystem::path& file : files) names.push_back(file.string());
    const image::Film::Window crop = result.film.crop();
    const render::RenderCounters& counters = result.counters;
    return {{"version", version()},
            {"files", names},
            {"scene_digest", sceneDigest},
            {"width", settings.width},
            {"height", settings.height},
            {"crop", {crop.x0, crop.y0, crop.x1, crop.y1}},
            {"seed", settings.seed},
            {"first_sample", settings.firstSample},
            {"end_sample", result.endSample},
            {"adaptive", settings.adaptive},
            {"samples_mean", result.film.meanSamples()},
            {"samples_fewest", result.film.fewestSamples()},
            {"samples_most", result.film.mostSamples()},
            {"reason", stopReasonName(result.reason)},
            {"load_seconds", loadSeconds},
            {"render_seconds", result.seconds},
            {"peak_memory_bytes", peakMemoryBytes()},
            {"noise", result.film.noise()},
            {"non_finite", result.film.nonFiniteCount()},
            {"needs", result.needs.describe()},
            {"counters",
             {{"paths", counters.paths},
              {"scatterings", counters.scatterings},
              {"shadow_rays", counters.shadowRays},
              {"distance_segments", counters.distanceSegments},
              {"distance_collisions", counters.distanceCollisions},
              {"shadow_segments", counters.shadowSegments},
              {"shadow_collisions", counters.shadowCollisions},
              {"clamped", counters.clamped}}}};
}

}  // namespace woodcock::tool
