// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "woodcock/render/approximations.h"
#include "woodcock/render/scene.h"

namespace woodcock::render {

/// The media that approximations use in place of the scene's own. Immutable while rendering and
/// shared by all threads.
struct ApproximateMedia {
    /// One for each medium: outside, then Scene::interiorMedia.
    using Set = std::vector<medium::Medium>;
    std::vector<Set> sets;  ///< with similarity one; with octaves one for each

    /// Throws Error{Usage} where `choice` asks for both octaves and similarity: octaves end the
    /// paths that similarity would change.
    ApproximateMedia(const Scene& scene, const Approximations& choice);
};

}  // namespace woodcock::render
