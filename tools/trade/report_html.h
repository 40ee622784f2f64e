// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace woodcock::tool {

/// The self-contained pages of what `woodcock trade` measures, from the JSON that it writes.
std::string tradePage(const nlohmann::json& report);
std::string scalingPage(const nlohmann::json& report);  ///< of `trade --scaling`
std::string needsPage(const nlohmann::json& report);    ///< of `trade --needs`

}  // namespace woodcock::tool
