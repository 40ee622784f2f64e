// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "woodcock/render/approximations.h"
#include "woodcock/render/scene.h"

namespace woodcock {

/// The media that paths go through instead of the scene's own where an approximation says so.
/// Immutable while rendering and shared by all threads.
struct StandIns {
    /// One for each medium: outside, then Scene::interiors.
    using Set = std::vector<Medium>;
    std::vector<Set> sets;  ///< with similarity one; with octaves one for each

    /// Throws Error{Usage} where `choice` asks for octaves and similarity: octaves have no paths
    /// that go on.
    StandIns(const Scene& scene, const Approximations& choice);
};

}  // namespace woodcock
