// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/view_depth.h"

#include <algorithm>
#include <array>
#include <limits>

#include "woodcock/medium/optical_depth.h"
#include "woodcock/render/scene.h"

namespace woodcock::render {

namespace {

constexpr double closedDepth = 10;
constexpr double closedShare = 0.1;  // mean free path in units of the medium's size
constexpr std::size_t raysPerSide = 5;
constexpr double infinity = std::numeric_limits<double>::infinity();

double distanceToSurface(const Scene& scene, const camera::CameraRay& ray) {
    surface::SurfaceHit hit;
    if (!scene.surfaces ||
        !scene.surfaces->geometry.intersect(ray.origin, ray.direction, infinity, nullptr, hit))
        return infinity;
    return hit.t;
}

/// The part with the shortest mean free path at a point; absent where there is none.
std::optional<ClosedView> densestAt(const medium::Medium& medium, Vec3d point) {
    double most = 0;
    ClosedView found;
    for (std::size_t i = 0; i < medium.parts.size(); ++i) {
        const double sigma = medium.parts[i].sigmaT(point).mean();
        if (sigma > most) most = sigma, found = {i, 0, 1 / sigma};
    }
    if (most == 0) return std::nullopt;
    return found;
}

}  // namespace

std::optional<ClosedView> findClosedView(const Scene& scene, int width, int height) {
    std::array<double, raysPerSide * raysPerSide> depths;
    const camera::CameraRay middle = scene.camera.ray(width / 2.0, height / 2.0, width, height);
    std::optional<ClosedView> view = densestAt(scene.medium, middle.origin);
    if (!view) return std::nullopt;
    const Box3d bounds = scene.medium.parts[view->part].worldBounds();
    if (!bounds.empty() && view->meanFreePath > closedShare * length(bounds.size()))
        return std::nullopt;
    if (scene.surfaces &&
        !scene.surfaces->geometry.enclosing(middle.origin, scene.surfaces->holdsMedium()).empty())
        return std::nullopt;
    for (std::size_t i = 0; i < depths.size(); ++i) {
        const double x = (static_cast<double>(i % raysPerSide) + 0.5) / raysPerSide * width;
        const double y = (static_cast<double>(i / raysPerSide) + 0.5) / raysPerSide * height;
        const camera::CameraRay ray = scene.camera.ray(x, y, width, height);
        depths[i] = medium::exactOpticalDepth(scene.medium, ray.origin, ray.direction, 0,
                                              distanceToSurface(scene, ray))
                        .mean();
    }
    std::sort(depths.begin(), depths.end());
    if (!(depths[depths.size() / 4] > closedDepth)) return std::nullopt;
    view->depth = depths[depths.size() / 2];
    return view;
}

}  // namespace woodcock::render
