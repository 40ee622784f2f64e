// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "woodcock/render/traced_scene.h"

namespace woodcock::render {

/// The pixels of a picture in which the camera surely sees nothing but an even background. All
/// their samples are alike, so no path is traced there. It changes no bit.
class EmptyPixels {
public:
    explicit EmptyPixels(const TracedScene& traced);

    bool holds(int x, int y) const;
    /// What every sample of such a pixel finds.
    const image::FilmSample& sample() const { return sample_; }

private:
    struct Window {
        double x0, y0, x1, y1;  ///< in pixels
    };
    bool known_ = false;           // which pixels are empty
    std::vector<Window> windows_;  // in which the camera may see a part of the medium
    image::FilmSample sample_;
};

}  // namespace woodcock::render
