// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

namespace woodcock::render {

struct Scene;

/// The view of a camera that sees only the medium next to it.
struct ClosedView {
    std::size_t part = 0;     ///< of Scene::medium: the densest one at the camera
    double depth = 0;         ///< optical depth of the view, a median over the picture
    double meanFreePath = 0;  ///< at the camera; world units
};

/// Present where the camera is inside of very dense media: at least three quarters of its rays have
/// an optical depth of more than 10 before any surface, and the mean free path at the camera is
/// less than a tenth of the medium's size. By exact optical depths along 25 rays. Absent where the
/// camera is inside of surfaces.
std::optional<ClosedView> findClosedView(const Scene& scene, int width, int height);

}  // namespace woodcock::render
