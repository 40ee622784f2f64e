// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/empty_pixels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "woodcock/camera/projection.h"

namespace woodcock::render {

namespace {

/// Whether nothing but the medium and its background can be seen, and that looks the same from all
/// directions; and nobody asks for more than the picture.
bool hasEvenBackground(const Scene& scene, const Needs& needs, const PathTracer::Options& options) {
    const light::LightSet& lights = scene.lights;
    if (needs.surfaces || needs.motion || scene.camera.motion || options.stoppedLight ||
        options.layers.depthSamples() || options.layers.stops || options.layers.parts.count() > 0 ||
        options.approximations.clamp > 0)
        return false;
    if (std::ranges::any_of(lights.meetable(),
                            [&](int light) { return lights.traits(light).visible; }))
        return false;
    return std::ranges::all_of(lights.distant(), [&](int light) {
        const light::LightTraits& traits = lights.traits(light);
        return !traits.visible || !traits.sampled;
    });
}

/// Marks the pixels in which boxes may be seen: those of the rectangle around each.
class Marks {
public:
    Marks(const camera::Camera& camera, int width, int height)
        : camera_(camera),
          width_(width),
          height_(height),
          changes_(static_cast<std::size_t>(width + 1) * static_cast<std::size_t>(height + 1)) {}

    /// False: a part of it is behind the camera.
    bool add(const Affine3d& worldFromBox, const Box3d& box) {
        double x0 = 1e30, y0 = 1e30, x1 = -1e30, y1 = -1e30;
        for (int i = 0; i < 8; ++i) {
            const auto at =
                camera::pixelOf(camera_, worldFromBox.point(box.corner(i)), width_, height_);
            if (!at) return false;
            x0 = std::min(x0, (*at)[0]), x1 = std::max(x1, (*at)[0]);
            y0 = std::min(y0, (*at)[1]), y1 = std::max(y1, (*at)[1]);
        }
        constexpr double margin = 1e-3;  // of a pixel, for rounding
        const auto pixel = [](double v, int size) {
            return static_cast<int>(std::clamp(std::floor(v), 0.0, size * 1.0));
        };
        const int left = pixel(x0 - margin, width_), right = pixel(x1 + margin + 1, width_);
        const int top = pixel(y0 - margin, height_), bottom = pixel(y1 + margin + 1, height_);
        if (left >= right || top >= bottom) return true;
        ++change(left, top), --change(right, top), --change(left, bottom), ++change(right, bottom);
        return true;
    }

    std::vector<bool> marked() {
        std::vector<bool> marked(static_cast<std::size_t>(width_) *
                                 static_cast<std::size_t>(height_));
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) {
                if (x > 0) change(x, y) += change(x - 1, y);
                if (y > 0) change(x, y) += change(x, y - 1);
                if (x > 0 && y > 0) change(x, y) -= change(x - 1, y - 1);
                marked[static_cast<std::size_t>(y * width_ + x)] = change(x, y) > 0;
            }
        return marked;
    }

private:
    /// How the number of boxes changes at a pixel, against its neighbours above and to the left.
    std::int32_t& change(int x, int y) {
        return changes_[static_cast<std::size_t>(y * (width_ + 1) + x)];
    }

    const camera::Camera& camera_;
    int width_, height_;
    std::vector<std::int32_t> changes_;
};

/// Marks where a field may be seen within an index-space box: cell by cell where they are not too
/// many. False: everywhere.
bool markField(const grid::MajorantGrid& majorants, const Affine3d& worldFromIndex,
               const Box3d& extent, Marks& marks) {
    constexpr std::size_t mostCells = 100'000;  // take some 20 ms
    if (extent.empty()) return true;
    if (majorants.entries() > mostCells) return marks.add(worldFromIndex, extent);
    bool all = true;
    majorants.forEachEntry([&](Vec3i first, int log2Size, grid::Range range) {
        if (range.max == 0 && range.min == 0) return;
        const Vec3d lower = first.as<double>();
        const double size = std::ldexp(1.0, log2Size);
        const Box3d cell{max(lower, extent.lower),
                         min(lower + Vec3d{size, size, size}, extent.upper)};
        if (!cell.empty()) all = all && marks.add(worldFromIndex, cell);
    });
    return all;
}

bool mark(const medium::MediumPart& part, Marks& marks) {
    const Affine3d& worldFromIndex = part.description().worldFromIndex;
    if (part.unbounded() || part.readElsewhere() || part.description().movement) return false;
    if (!part.field() || part.limits())
        return part.extent().empty() || marks.add(worldFromIndex, part.extent());
    return markField(part.majorants(), worldFromIndex, part.extent(), marks);
}

bool mark(const medium::EmissionPart& part, Marks& marks) {
    const medium::EmissionPart::Description& d = part.description();
    if (d.motion || d.movement) return false;
    if (!d.field || d.field->limits())
        return part.extent().empty() || marks.add(d.worldFromIndex, part.extent());
    return markField(part.majorants(), d.worldFromIndex, part.extent(), marks);
}

}  // namespace

EmptyPixels::EmptyPixels(const Scene& scene, const Needs& needs, const PathTracer::Options& options)
    : width_(options.width) {
    if (!hasEvenBackground(scene, needs, options)) return;
    Marks marks(scene.camera, options.width, options.height);
    for (const medium::MediumPart& part : scene.medium.parts)
        if (!mark(part, marks)) return;
    for (const medium::EmissionPart& part : scene.medium.emission)
        if (!mark(part, marks)) return;
    seen_ = marks.marked();
    for (const int light : scene.lights.distant()) {
        const Rgb radiance = scene.lights.distantRadiance(light, {0, 0, 1}, true);
        sample_.radiance += radiance, sample_.background += radiance;
    }
}

}  // namespace woodcock::render
