// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/render/scene.h"
#include "woodcock/render/session.h"

namespace woodcock::tool {

/// A small render of the whole picture, about 96 x 54 pixels of 16 samples, with the seed and the
/// methods of `settings`. What a scene leaves open about a picture is chosen by it. The first
/// Ctrl-C ends it early.
render::RenderResult renderTrial(const render::Scene& scene,
                                 const render::RenderSettings& settings);

}  // namespace woodcock::tool
