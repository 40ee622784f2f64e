// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace woodcock::tool {

// The self-contained pages of what `woodcock trade` measures, from the JSON that it writes.

/// `answers`: of answersJson().
std::string tradePage(const nlohmann::json& report, const nlohmann::json& answers);
std::string scalingPage(const nlohmann::json& report);  ///< of `trade --scaling`
std::string needsPage(const nlohmann::json& report);    ///< of `trade --needs`

}  // namespace woodcock::tool
