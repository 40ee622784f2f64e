// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/common/render_command.h"
#include "woodcock/trade/trade.h"

namespace woodcock::tool {

/// What `woodcock trade` was asked, and what it found.
struct TradeReport {
    std::string commandLine, scene, digest;
    RenderCommand command;
    int threads = 0;
    double budget = 0;
    std::vector<std::string> pictures = {};  ///< data: URLs of the result's crops
    trade::TradeResult result = {};
};

/// Tables for a terminal 100 columns wide.
std::string tradeText(const TradeReport& report);
/// `withPictures`: for the page.
nlohmann::ordered_json tradeJson(const TradeReport& report, bool withPictures);
/// A line for each candidate and number of samples.
std::string tradeCsv(const TradeReport& report);

}  // namespace woodcock::tool
