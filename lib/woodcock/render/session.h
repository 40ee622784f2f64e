// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "woodcock/image/film.h"
#include "woodcock/render/approximations.h"
#include "woodcock/render/needs.h"
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
    double noise = 0;            ///< stop once Film::noise() is below it; 0: never
    bool depthLayers = false;    ///< also sample transmittance and depth of camera rays
    bool featureLayers = false;  ///< these, and albedo and normal of what they meet
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

struct RenderResult {
    image::Film film;
    Needs needs;
    StopReason reason = StopReason::Complete;
    /// Samples [firstSample, endSample) are complete in every pixel; of an adaptive render, as much
    /// work is.
    int endSample = 0;
    double seconds = 0;
    RenderCounters counters;
};

/// Renders `scene`. The same scene, seed and sample range give the same film, bit for bit, whatever
/// the number of threads. It renders in passes over the whole crop, so that a stop leaves an even
/// picture. With `adaptive`, each pixel gets its share of a pass; the shares depend on the crop.
/// `onProgress` is called a few times a second from one thread. If it returns false, rendering
/// stops at once, as it does at the time limit. Finished tiles of the current pass are kept. So
/// some pixels may hold more samples than endSample - firstSample (see Film::Pixel::samples), or
/// none where the first pass is stopped. Unfinished tiles do not count: their short paths would be
/// kept more often than their long ones.
/// Throws Error{Usage} on an empty crop, image or sample range, and on an adaptive render of a
/// range that does not begin at 0.
RenderResult render(const Scene& scene, const RenderSettings& settings,
                    const std::function<bool(const RenderProgress&)>& onProgress = {});

}  // namespace woodcock::render
