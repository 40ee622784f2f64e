// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>
#include <string_view>

#include "tools/common/json_text.h"
#include "tools/pages/page.h"
#include "tools/trade/report_html.h"

namespace woodcock::tool {

// Of ../pages and page/, see their CMakeLists.txt.
extern const std::string_view pageChart, pageChartRows, pageChartStyle;
extern const std::string_view tradePageStyle, tradePageModel, tradePageWords, tradePageChoose,
    tradePagePlots, tradePageTables, tradePageCrops, tradePageStart;
extern const std::string_view scalingPageScript, needsPageScript;

namespace {

nlohmann::json numbers(const trade::Measured& m) { return {{"value", m.value}, {"se", m.se}}; }

/// The numbers that the page needs for any time and any error: for each candidate what its bias is,
/// what its noise is times the time, and how well the latter's difference from each other
/// candidate's is known.
nlohmann::json modelsJson(const std::vector<trade::TradeModel>& models) {
    nlohmann::json candidates = nlohmann::json::array();
    for (const trade::TradeModel& model : models) {
        if (model.costs.empty()) {
            candidates.push_back(nullptr);
            continue;
        }
        nlohmann::json differences = nlohmann::json::array();
        for (const trade::TradeModel& other : models)
            differences.push_back(trade::noiseDifferenceError(model, other));
        candidates.push_back({{"seconds_per_sample", model.secondsPerSample},
                              {"bias", numbers({model.biasError(), model.squaredBias.se})},
                              {"noise", numbers(model.noise())},
                              {"noise_difference_se", std::move(differences)}});
    }
    return {{"tie_width", trade::tieWidth}, {"candidates", std::move(candidates)}};
}

}  // namespace

std::string tradePage(const nlohmann::json& report, const std::vector<trade::TradeModel>& models) {
    return makePage(
        {"woodcock trade",
         {pageChartStyle, tradePageStyle},
         {{"report", jsonText(report, -1)}, {"models", jsonText(modelsJson(models), -1)}},
         {pageChart, pageChartRows, tradePageModel, tradePageWords, tradePageChoose, tradePagePlots,
          tradePageTables, tradePageCrops, tradePageStart}});
}

std::string scalingPage(const nlohmann::json& report) {
    return makePage({"woodcock trade --scaling",
                     {pageChartStyle},
                     {{"report", jsonText(report, -1)}},
                     {pageChart, pageChartRows, scalingPageScript}});
}

std::string needsPage(const nlohmann::json& report) {
    return makePage({"woodcock trade --needs",
                     {pageChartStyle},
                     {{"report", jsonText(report, -1)}},
                     {pageChart, pageChartRows, needsPageScript}});
}

}  // namespace woodcock::tool
