// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "woodcock/trade/trade.h"

namespace woodcock::tool {

/// What to take for any time and any error that a reader of the page may ask for: the page looks it
/// up and computes nothing. `budget`: the run's, in seconds.
///
/// {"cost": [variance x seconds of each candidate], "time": ANSWERS, "error": ANSWERS}, where
/// ANSWERS is {"targets": [what can be asked for, ascending], "sensible": [first, last of them that
/// tell candidates apart], "rendering": WEIGHED, "with_loading": WEIGHED}, and WEIGHED is {"value":
/// for each candidate and target the error or the seconds, "se": their standard errors, "all":
/// CHOSEN, "unbiased": CHOSEN}. CHOSEN has lists of one element for each target, null where nobody
/// can: "best", "tied", "recommended" as in trade::Winner, and "samples" of the recommended one.
nlohmann::json answersJson(const trade::TradeResult& result, double budget);

}  // namespace woodcock::tool
