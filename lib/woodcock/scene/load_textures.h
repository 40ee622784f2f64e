// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "woodcock/scene/description.h"
#include "woodcock/surface/texture.h"

namespace woodcock::scene {

/// The image of each material, each file read once; null where it has none. Throws Error{Input}
/// with the place in the scene on images that cannot be read, and on such as would make a surface
/// reflect more light than it gets.
std::vector<std::shared_ptr<const surface::TextureImage>> loadTextures(
    const SceneDescription& scene);

/// The description's colour times the image. What reflects is brought down to 1 where rounding put
/// it above.
surface::Texture makeTexture(const TextureDescription& description,
                             std::shared_ptr<const surface::TextureImage> image);

}  // namespace woodcock::scene
