// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/empty_pixels.h"

#include <algorithm>

#include "woodcock/camera/projection.h"

namespace woodcock::render {

namespace {

/// Whether nothing but the medium and its background can be seen, and that looks the same from all
/// directions; and nobody asks for more than the picture.
bool hasEvenBackground(const TracedScene& traced) {
    const PathTracer::Options& options = traced.options;
    const light::LightSet& lights = traced.scene.lights;
    if (traced.needs.surfaces || traced.needs.emission || traced.needs.motion ||
        traced.scene.camera.motion || !lights.meetable().empty() || options.stoppedLight ||
        options.layers.depthSamples() || options.layers.stops || options.layers.parts.count() > 0 ||
        options.approximations.clamp > 0)
        return false;
    return std::ranges::all_of(lights.distant(), [&](int light) {
        const light::LightTraits& traits = lights.traits(light);
        return !traits.visible || !traits.sampled;
    });
}

}  // namespace

EmptyPixels::EmptyPixels(const TracedScene& traced) {
    if (!hasEvenBackground(traced)) return;
    constexpr double margin = 1e-3;  // for rounding
    for (std::uint8_t set = 0; set <= 1; ++set) {
        if (set > 0 && !traced.media.replaces()) break;
        for (const medium::MediumPart& part : traced.mediumOfSet(set).parts) {
            if (part.unbounded()) return;
            const Box3d box = part.worldBounds();
            Window window{1e30, 1e30, -1e30, -1e30};
            for (int i = 0; i < 8 && !box.empty(); ++i) {
                const auto at = camera::pixelOf(traced.scene.camera, box.corner(i),
                                                traced.options.width, traced.options.height);
                if (!at) return;  // it reaches behind the camera
                const auto [x, y] = *at;
                window = {std::min(window.x0, x - margin), std::min(window.y0, y - margin),
                          std::max(window.x1, x + margin), std::max(window.y1, y + margin)};
            }
            windows_.push_back(window);
        }
    }
    known_ = true;
    for (const int light : traced.scene.lights.distant()) {
        const Rgb seen = traced.scene.lights.distantRadiance(light, {0, 0, 1}, true);
        sample_.radiance += seen, sample_.background += seen;
    }
}

bool EmptyPixels::holds(int x, int y) const {
    return known_ && std::ranges::none_of(windows_, [&](const Window& w) {
               return x + 1 >= w.x0 && x <= w.x1 && y + 1 >= w.y0 && y <= w.y1;
           });
}

}  // namespace woodcock::render
