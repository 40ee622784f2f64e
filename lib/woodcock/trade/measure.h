// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "woodcock/denoise/denoiser.h"
#include "woodcock/render/preparation.h"
#include "woodcock/render/scene.h"
#include "woodcock/scene/description.h"
#include "woodcock/trade/estimate.h"
#include "woodcock/trade/plan.h"

namespace woodcock::trade {

/// Seconds since it was made.
class Stopwatch {
public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// A scene that is ready to be rendered.
struct BuiltScene {
    render::Scene scene;
    double loadSeconds = 0;  ///< loading and building
    std::size_t bytes = 0;   ///< held by fields and majorants
    /// What renders of it share. Its time would count for much in small pictures, and counts for
    /// little in large ones.
    mutable std::vector<std::shared_ptr<const render::Preparation>> prepared = {};

    std::shared_ptr<const render::Preparation> preparation(
        PictureSize size, const render::Approximations& approximations) const;
};

/// Loads each scene once: candidates that differ only in rendering share it.
class SceneStore {
public:
    const BuiltScene& get(const scene::SceneDescription& scene);
    bool has(const scene::SceneDescription& scene) const;

private:
    struct Entry {
        scene::SceneDescription key;
        BuiltScene built;
    };
    std::list<Entry> entries_;
};

/// A candidate to render, at the size at which it is measured. Levels of detail are those of the
/// scene's own size, at which it was loaded.
struct Subject {
    const render::Scene* scene = nullptr;
    std::shared_ptr<const render::Preparation> prepared;
    scene::RenderDescription render;
    std::optional<denoise::Denoiser> denoiser;  ///< of its pictures; absent: none
    Subject() = default;
    Subject(const BuiltScene& built, const scene::SceneDescription& description, PictureSize size,
            std::optional<denoise::Denoiser> pictureDenoiser = {})
        : scene(&built.scene),
          prepared(built.preparation(size, description.render.approximations)),
          render(description.render),
          denoiser(std::move(pictureDenoiser)) {
        render.width = size.width, render.height = size.height;
    }
};

/// Returns whether to go on; called a few times a second.
using GoOn = std::function<bool()>;

/// A picture after some number of samples, and the cost of all samples so far.
struct Stage {
    int samples = 0;  ///< per pixel, or as much work
    Pixels pixels;
    double seconds = 0, cpuSeconds = 0;
    double noise = 0;           ///< Film::noise()
    double denoiseSeconds = 0;  ///< of this picture alone; not in `seconds`
};
/// Renders `samples` samples per pixel; the stages are at these counts, which rise. Absent where
/// `goOn` returned false.
std::optional<std::vector<Stage>> renderStages(const Subject& subject, std::uint64_t seed,
                                               const std::vector<int>& samples, int threads,
                                               const GoOn& goOn);

/// A sixteenth and a quarter of the samples, where these are samples, and all.
std::vector<int> stageCounts(int samples);

}  // namespace woodcock::trade
