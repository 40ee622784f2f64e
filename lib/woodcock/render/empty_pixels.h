// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "woodcock/render/path_tracer.h"

namespace woodcock::render {

/// The pixels of a picture in which the camera surely sees nothing but an even background. All
/// their samples are alike, so no path is traced there. It changes no bit. Shared by all threads.
class EmptyPixels {
public:
    /// There are none where somebody asks for more of a path than the picture.
    EmptyPixels(const Scene& scene, const Needs& needs, const PathTracer::Options& options);

    bool holds(int x, int y) const {
        return !seen_.empty() && !seen_[static_cast<std::size_t>(y * width_ + x)];
    }
    /// What every sample of such a pixel finds.
    const image::FilmSample& sample() const { return sample_; }

private:
    int width_;
    std::vector<bool> seen_;  // whether a pixel may see the medium; empty: any may
    image::FilmSample sample_;
};

}  // namespace woodcock::render
