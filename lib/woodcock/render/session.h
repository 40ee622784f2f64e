// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/image/deep_film.h"
#include "woodcock/image/film.h"
#include "woodcock/image/matte_film.h"
#include "woodcock/render/approximations.h"
#include "woodcock/render/needs.h"
#include "woodcock/render/sample_plan.h"
#include "woodcock/render/scene.h"

namespace woodcock::render {

struct RenderSettings {
    int width = 960, height = 540;
    std::optional<image::Film::Window> crop;  ///< absent: the whole image
    int firstSample = 0, endSample = 64;      ///< the half-open range of sample indices to render
    std::uint64_t seed = 0;
    std::optional<int> maxScatterings;  ///< absent: unlimited
    std::optional<int> maxBounces;      ///< off surfaces; absent: unlimited
    Approximations approximations;
    /// Distributes samples by error, for the work of [firstSample, endSample) in every pixel: see
    /// SamplePlan.
    bool adaptive = false;
    int threads = 0;  ///< 0: all cores
    /// Seconds; 0: none. The first sample of all pixels may take twice as long.
    double timeLimit = 0;
    double noise = 0;  ///< stop once Film::noise() is below it; 0: never
    image::LayerNeeds layers = {};
    // By tracked camera rays; see compositingFlaw().
    std::vector<image::MatteLayer> mattes = {};  ///< coverage by name
    double deepError = 0;  ///< deep pixels with at most this error: see DeepBins; 0: none
};

struct RenderProgress {
    double fraction = 0;     ///< of the planned work, 0 to 1
    double seconds = 0;      ///< since the render began
    double secondsLeft = 0;  ///< estimate
    int samples = 0;         ///< per pixel (or as much work), complete so far
    ///< Film::noise() after a complete pass, mostly the last; infinite before
    double noise = std::numeric_limits<double>::infinity();
};

enum class StopReason { Complete, TimeLimit, NoiseReached, Interrupted };

/// Where a render stands: all that it needs to go on to the same bits.
struct RenderState {
    image::Film film;
    std::optional<image::MatteFilm> mattes = {};  ///< where they are asked for
    std::optional<image::DeepFilm> deep = {};
    /// Of each pixel of the crop, row by row: the film holds its samples [firstSample, drawn).
    std::vector<std::uint32_t> drawn = {};
    /// Samples [firstSample, endSample) are complete in every pixel; of an adaptive render, as much
    /// work is.
    int endSample = 0;
    int passLength = 1;  ///< samples of the pass that begins at endSample, if none ends it earlier
    std::optional<SamplePlan> plan = {};  ///< of an adaptive render, once there is the pilot
    double seconds = 0;                   ///< so far, those before an interruption included
    RenderCounters counters = {};
};

struct RenderResult : RenderState {
    Needs needs;
    StopReason reason = StopReason::Complete;
};

/// How a render is kept from being lost.
struct Checkpoints {
    /// Goes on from here; absent: begins. It must be of the same scene and settings, where threads,
    /// limits and, without `adaptive`, endSample may differ. That is the caller's to know.
    std::optional<RenderState> from = {};
    /// Asked some times a second whether a checkpoint is to be written.
    std::function<bool()> wanted = {};
    /// Gets a copy of the state, between tiles. The render goes on meanwhile. Must not throw.
    std::function<void(const RenderState&)> write = {};
    /// Whether there are to be some: deep pixels that leave no memory for a copy are refused.
    bool planned = false;
};

/// Why there can be no mattes or deep pixels with these approximations; empty: there can.
std::string compositingFlaw(const Approximations& approximations, bool deep);

/// Renders `scene`. The same scene, seed and sample range give the same film, bit for bit, whatever
/// the number of threads. It renders in passes over the whole crop, so that a stop leaves an even
/// picture. With `adaptive`, each pixel gets its share of a pass; the shares depend on the crop.
/// `onProgress` is called a few times a second from one thread. If it returns false, rendering
/// stops at once, as it does at the time limit. Finished tiles of the current pass are kept. So
/// some pixels may hold more samples than endSample - firstSample (see Film::Pixel::samples), or
/// none where the first pass is stopped. Unfinished tiles do not count: their short paths would be
/// kept more often than their long ones.
/// A render that goes on from a checkpoint gives the film of one that was never interrupted, bit
/// for bit; only what a time limit ends depends on the machine. The limit includes the time before.
/// Throws Error{Usage} on an empty crop, image or sample range, on an adaptive render of a range
/// that does not begin at 0, on mattes or deep pixels that compositingFlaw() is against, and on a
/// checkpoint of another size, with other sums or with more samples than are asked for.
RenderResult render(const Scene& scene, const RenderSettings& settings,
                    const std::function<bool(const RenderProgress&)>& onProgress = {},
                    Checkpoints checkpoints = {});

}  // namespace woodcock::render
