// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "tools/bake/frames.h"
#include "woodcock/bake/baker.h"

namespace woodcock::tool {

/// Tells the log what was baked, and warns of what was cut off.
void reportBake(const bake::Bake& bake);

/// What --json says of a bake and of the files that it wrote.
nlohmann::ordered_json bakeJson(const bake::Recipe& recipe, const bake::Bake& bake,
                                const BakeFrame& frame,
                                const std::vector<std::filesystem::path>& files);

}  // namespace woodcock::tool
