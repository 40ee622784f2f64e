// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "woodcock/render/traced_scene.h"

namespace woodcock::render {

/// Bins of depth for deep pixels, from four rays through each pixel, before anything is rendered.
/// They are as few as keep two errors below `error`, at any depth and in the mean of these rays:
/// that of the transmittance, where it falls exponentially within each bin; and that of the share
/// of emitted light in front of this depth. No bin stops more than a tenth of the light, as its
/// colour is one. Surfaces that the rays end at are edges.
///
/// What is rendered does not depend on them, only where in a bin it is. The light that all of a
/// bin stops and sends is measured by the render's own paths.
class DeepBins {
public:
    /// `scene` must outlive this.
    DeepBins(const Scene& scene, const Needs& needs, int width, int height, double error);

    /// Planar depths in order: none, or two and more.
    std::vector<float> edges(int x, int y) const;

private:
    /// A place on a ray's way.
    struct Node {
        double depth;
        double stopped;  ///< by media, of the light so far
        double emitted;  ///< that has arrived from in front of it
    };
    struct Ray {
        std::vector<Node> nodes;
        double surface = -1;  ///< depth of that which ends it; negative: none
        double surfaceStops = 0;
    };
    Ray ray(double x, double y) const;

    const TracedScene traced_;
    double error_;
};

}  // namespace woodcock::render
