// SPDX-License-Identifier: Apache-2.0
#include "woodcock/surface/surface_set.h"

namespace woodcock::surface {

std::vector<bool> SurfaceSet::holdsMedium() const {
    std::vector<bool> holds;
    for (const SurfaceObject& object : objects) holds.push_back(object.holdsMedium);
    return holds;
}

}  // namespace woodcock::surface
