// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "woodcock/render/session.h"

namespace woodcock::tool {

/// The JSON of --stats.
std::string statsText(const RenderResult& result, const RenderSettings& settings,
                      const std::string& sceneDigest, double loadSeconds);

}  // namespace woodcock::tool
