// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "woodcock/render/session.h"

namespace woodcock::tool {

/// The most memory that the program held at once.
std::uint64_t peakMemoryBytes();

/// The object of --stats and --json. `files` are the images that the render wrote.
nlohmann::ordered_json statsJson(const render::RenderResult& result,
                                 const render::RenderSettings& settings,
                                 const std::string& sceneDigest, double loadSeconds,
                                 const std::vector<std::filesystem::path>& files);

}  // namespace woodcock::tool
