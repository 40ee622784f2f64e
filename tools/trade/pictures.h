// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "woodcock/scene/description.h"
#include "woodcock/trade/trade.h"

namespace woodcock::tool {

/// The result's crops through the scene's display transform, as data: URLs of PNG files.
std::vector<std::string> tradePictures(const trade::TradeResult& result,
                                       const scene::SceneDescription& scene);

}  // namespace woodcock::tool
