// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/next_frame.h"

#include "woodcock/camera/projection.h"

namespace woodcock::render {

namespace {

const NextFrame::Way nowhere;

}  // namespace

std::array<float, 2> NextFrame::motion(const Way& way, Vec3d point, int width, int height) const {
    const auto from = camera::pixelOf(now, point, width, height);
    const auto to = camera::pixelOf(then, way ? way(point) : point, width, height);
    if (!from || !to) return {};
    return {static_cast<float>((*to)[0] - (*from)[0]), static_cast<float>((*to)[1] - (*from)[1])};
}

const NextFrame::Way& NextFrame::ofPart(std::size_t medium, std::size_t part) const {
    return medium < media.size() && part < media[medium].size() ? media[medium][part] : nowhere;
}

const NextFrame::Way& NextFrame::ofInstance(std::size_t instance) const {
    return instance < instances.size() ? instances[instance] : nowhere;
}

}  // namespace woodcock::render
