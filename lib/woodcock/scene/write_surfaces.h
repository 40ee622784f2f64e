// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/scene/description.h"
#include "woodcock/scene/scene_writer.h"

namespace woodcock {

// Sections of writeScene(). Of scene/ only.

void writeMaterial(SceneWriter& out, const MaterialDescription& material);
void writeSurface(SceneWriter& out, const SurfaceDescription& surface);

}  // namespace woodcock
