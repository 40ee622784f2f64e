// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "woodcock/camera/camera.h"

namespace woodcock::render {

/// Where what a frame shows goes until the next one, for the layer of motion. The shutter has no
/// say in it.
struct NextFrame {
    /// Where a point in world space goes; empty: it stands still.
    using Way = std::function<Vec3d(Vec3d)>;

    camera::Camera now, then;             ///< at this frame and at the next, both without motion
    std::vector<std::vector<Way>> media;  ///< of the scene's own and of those inside of surfaces:
                                          ///< of each part
    std::vector<Way> instances;           ///< of surfaces

    /// By how many pixels, right and down, a point moves in a picture of this size; 0 where the
    /// camera cannot see it at either frame.
    std::array<float, 2> motion(const Way& way, Vec3d point, int width, int height) const;
    const Way& ofPart(std::size_t medium, std::size_t part) const;
    const Way& ofInstance(std::size_t instance) const;
};

}  // namespace woodcock::render
