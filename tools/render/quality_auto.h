// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/render/options.h"

namespace woodcock::tool {

/// `--quality auto`: measures what choices cost and bring on this complete scene, for a tenth of
/// the time limit or half a minute at most, and gives it those whose expected error is least in the
/// time that is left, or the least time to the noise that is asked for. The log tells which and
/// why. False where the user interrupted it.
bool chooseQuality(scene::SceneDescription& scene, const RenderOptions& options,
                   const std::string& commandLine);

}  // namespace woodcock::tool
