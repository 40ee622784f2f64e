// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/preparation.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace woodcock::render {

namespace {

/// Those that decide what is made.
Approximations ofPreparation(const Approximations& a) {
    Approximations kept;
    kept.marchStep = a.marchStep;
    kept.octaves = a.octaves;
    if (a.similarityAfter) kept.similarityAfter = 0;  // after any scattering, the same media
    return kept;
}

}  // namespace

Preparation::Preparation(const Scene& scene, int width, int height,
                         const Approximations& approximations)
    : scene_(scene),
      width_(width),
      height_(height),
      approximations_(ofPreparation(approximations)),
      approximateMedia_(scene, approximations),
      lightDepths_(scene, approximations, approximateMedia_),
      cameraDepths_(CameraDepths::make(scene, width, height)),
      radianceLattice_(RadianceLattice::make(scene)) {}

bool Preparation::fits(const Scene& scene, int width, int height,
                       const Approximations& approximations) const {
    return &scene == &scene_ && width == width_ && height == height_ &&
           ofPreparation(approximations) == approximations_;
}

void Preparation::fill(int threads, const std::function<bool()>& goOn) const {
    tbb::task_arena(threads > 0 ? threads : tbb::task_arena::automatic).execute([&] {
        fillLightDepths(goOn), fillCameraDepths(goOn);
    });
}

void Preparation::fillLightDepths(const std::function<bool()>& goOn) const {
    const std::size_t sets = 1 + approximateMedia_.sets.size();
    for (std::size_t set = 0; set < sets; ++set)
        for (std::size_t light = 0; light < scene_.lights.lights().size(); ++light) {
            const medium::DepthGrid* grid =
                lightDepths_.find(static_cast<std::uint8_t>(set), static_cast<int>(light));
            if (!grid) continue;
            const Vec3i cells = grid->cells();
            tbb::parallel_for(0, cells.y, [&](int j) {
                for (int i = 0; i < cells.x && goOn(); ++i) grid->nodes(i, j, 0);
            });
        }
}

void Preparation::fillCameraDepths(const std::function<bool()>& goOn) const {
    if (!cameraDepths_) return;
    constexpr int places = 512;  // across the picture: there are fewer lines
    tbb::parallel_for(0, places, [&](int j) {
        for (int i = 0; i < places && goOn(); ++i)
            cameraDepths_->at((i + 0.5) * width_ / places, (j + 0.5) * height_ / places);
    });
}

}  // namespace woodcock::render
