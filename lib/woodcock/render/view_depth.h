// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

namespace woodcock {

struct Scene;

/// A camera that sees nothing but the medium next to it.
struct ClosedView {
    std::size_t part = 0;     ///< of Scene::medium: the densest where the camera stands
    double depth = 0;         ///< optical depth of the view, a median over the picture
    double meanFreePath = 0;  ///< where the camera stands; world units
};

/// Whether the camera stands within media so dense that at least three quarters of its rays
/// have an optical depth of more than 10 before anything else, and the mean free path at the camera
/// is less than a tenth of the medium's size. Exact along 25 rays; absent otherwise, and inside of
/// surfaces.
std::optional<ClosedView> findClosedView(const Scene& scene, int width, int height);

}  // namespace woodcock
