// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "woodcock/image/film.h"
#include "woodcock/image/stopped_light.h"
#include "woodcock/render/approximate_media.h"
#include "woodcock/render/approximations.h"
#include "woodcock/render/camera_depths.h"
#include "woodcock/render/light_depths.h"
#include "woodcock/render/needs.h"
#include "woodcock/render/radiance_lattice.h"
#include "woodcock/render/scene.h"

namespace woodcock::render {

class EmptyPixels;

/// One camera path to trace.
struct PathJob {
    int x = 0, y = 0;  ///< pixel, y down
    std::uint32_t sample = 0;
};

/// What one camera path found.
struct PathResult {
    image::FilmSample film;
    image::DepthSample depth;  ///< only where layers ask for it
    image::CatcherSample
        catcher;  ///< where the camera sees a shadow catcher; its radiance is not in `film`
    std::unique_ptr<image::StoppedLight> stopped;  ///< only with stoppedLight
};

/// What layers ask of paths beside a PathResult; empty where they do not.
struct PathLayers {
    std::span<Rgb> parts;  ///< of FilmSample::radiance: options.layers.parts.count() for each job
    std::span<image::PlaceSample> places;  ///< one for each job
    std::span<image::StopSample> stops;    ///< one for each job
};

/// Traces camera paths through a scene in batches; path_tracer.cpp says how. Use one object for
/// each thread, for as many calls as it has: it keeps its buffers. The result of a job depends on
/// the scene, the seed and the job only, never on other jobs.
class PathTracer {
public:
    struct Options {
        int width = 1, height = 1;  ///< of the image
        std::uint64_t seed = 0;
        std::optional<int> maxScatterings;
        std::optional<int> maxBounces;
        Approximations approximations;
        image::LayerNeeds layers = {};
        bool stoppedLight = false;  ///< of tracked rays only; it changes nothing else
        const ApproximateMedia* approximateMedia =
            nullptr;                                 ///< made from `approximations`; null: no sets
        const LightDepths* lightDepths = nullptr;    ///< null: shadow rays are tracked
        const CameraDepths* cameraDepths = nullptr;  ///< null: camera rays are walked
        const RadianceLattice* radiance = nullptr;   ///< null: nothing is known of it
        const EmptyPixels* emptyPixels = nullptr;    ///< null: paths are traced in all
        bool lanes = true;  ///< false: paths are traced one by one, also where lanes/ could
    };

    virtual ~PathTracer() = default;
    /// Fills results[i], and what belongs to it in `layers`, for jobs[i]; adds what that took to
    /// `counters`. `stop` is called now and then; once it returns true, trace() returns false, the
    /// results are void, and `counters` stay as they were.
    virtual bool trace(std::span<const PathJob> jobs, std::span<PathResult> results,
                       const PathLayers& layers, const std::function<bool()>& stop,
                       RenderCounters& counters) = 0;
    bool trace(std::span<const PathJob> jobs, std::span<PathResult> results,
               const std::function<bool()>& stop, RenderCounters& counters) {
        return trace(jobs, results, {}, stop, counters);
    }

    /// The tracer for the fewest channels that the scene needs. The scene, and
    /// options.approximateMedia, must outlive it.
    static std::unique_ptr<PathTracer> make(const Scene& scene, const Needs& needs,
                                            const Options& options);
};

}  // namespace woodcock::render
