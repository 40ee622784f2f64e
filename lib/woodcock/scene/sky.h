// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "woodcock/image/read_image.h"
#include "woodcock/scene/light_descriptions.h"

namespace woodcock::scene {

/// What a sky consists of: radiance from all around, and a sun.
struct SkyParts {
    EnvironmentDescription environment;  ///< without the file of its image, which follows
    image::Image image;
    std::optional<SunDescription> sun;
};
SkyParts partsOf(const SkyDescription& sky);

}  // namespace woodcock::scene
