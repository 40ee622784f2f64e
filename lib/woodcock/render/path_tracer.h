// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "woodcock/image/film.h"
#include "woodcock/medium/marching.h"
#include "woodcock/render/approximate_media.h"
#include "woodcock/render/approximations.h"
#include "woodcock/render/needs.h"
#include "woodcock/render/scene.h"

namespace woodcock::render {

/// How rays are marched where approximations.marchStep is above 0.
inline medium::MarchSettings marchSettings(const Approximations& approximations) {
    return {approximations.marchStep, approximations.jackknife};
}

/// One camera path to trace.
struct PathJob {
    int x = 0, y = 0;  ///< pixel, y down
    std::uint32_t sample = 0;
};

/// What one camera path found.
struct PathResult {
    image::FilmSample film;
    image::DepthSample depth;  ///< only with depthLayers or featureLayers
    image::CatcherSample
        catcher;  ///< where the camera sees a shadow catcher; its radiance is not in `film`
};

/// Traces camera paths through a scene in batches: spawn, look ahead, walk, shade, shadow walk,
/// retire. Use one object for each thread. The result of a job depends on the scene, the seed and
/// the job only, never on the other jobs of its batch.
class PathTracer {
public:
    struct Options {
        int width = 1, height = 1;  ///< of the image
        std::uint64_t seed = 0;
        std::optional<int> maxScatterings;
        std::optional<int> maxBounces;
        Approximations approximations;
        bool depthLayers = false, featureLayers = false;
        const ApproximateMedia* approximateMedia =
            nullptr;  ///< made from `approximations`; null: no sets
    };

    virtual ~PathTracer() = default;
    /// Fills results[i] for jobs[i]. `stop` is called now and then; once it returns true, trace()
    /// returns false and the results are void.
    virtual bool trace(std::span<const PathJob> jobs, std::span<PathResult> results,
                       const std::function<bool()>& stop) = 0;
    virtual const RenderCounters& counters() const = 0;

    /// The tracer for the fewest channels that the scene needs.
    static std::unique_ptr<PathTracer> make(const Scene& scene, const Needs& needs,
                                            const Options& options);
};

}  // namespace woodcock::render
