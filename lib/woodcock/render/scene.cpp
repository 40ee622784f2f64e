// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/scene.h"

namespace woodcock::render {

Box3d Scene::bounds() const {
    Box3d all = medium.worldBounds();
    if (!surfaces) return all;
    const Box3d box = surfaces->geometry.bounds();
    if (!box.empty()) all.add(box.lower), all.add(box.upper);
    return all;
}

}  // namespace woodcock::render
