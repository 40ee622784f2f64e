// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/render/scene.h"
#include "woodcock/render/session.h"

namespace woodcock::tool {

/// Logs what the scene needs of the renderer.
void reportNeeds(const render::Scene& scene);

/// Logs numbers that say how well the render went.
void reportResult(const render::RenderResult& result, const render::RenderSettings& settings);

}  // namespace woodcock::tool
