// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/image/film_state.h"
#include "woodcock/image/write_exr.h"
#include "woodcock/scene/description.h"

namespace woodcock::tool {

/// What files with sums tell of the pictures that are to be made of them.
struct PictureFacts {
    scene::OutputDescription output;  ///< but for the files
    std::filesystem::path ocio;
    bool withAlpha = false, glows = false;  ///< as in image::OutputSettings
    image::RenderMetadata shot;             ///< what scene::describeShot() says, and no more
};

/// Of a scene: those, and the digests that tell scenes apart.
image::StateFacts factsOf(const scene::SceneDescription& scene);
/// Throws Error{Input} where the file does not tell them.
PictureFacts pictureFactsOf(const image::StateFile& file);

}  // namespace woodcock::tool
