// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "woodcock/trade/model.h"

namespace woodcock::tool {

// The self-contained pages of what `woodcock trade` measures, from the JSON that it writes.

/// `models`: one for each of the report's candidates; no costs where it was not measured.
std::string tradePage(const nlohmann::json& report, const std::vector<trade::TradeModel>& models);
std::string scalingPage(const nlohmann::json& report);  ///< of `trade --scaling`
std::string needsPage(const nlohmann::json& report);    ///< of `trade --needs`

}  // namespace woodcock::tool
