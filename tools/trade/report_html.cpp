// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>
#include <string_view>

#include "tools/pages/page.h"
#include "tools/trade/report_html.h"

namespace woodcock {
extern const std::string_view pageChart;       // page_chart.js
extern const std::string_view pageChartStyle;  // page_chart.css
extern const std::string_view tradePageStyle;  // trade_page.css
extern const std::string_view tradePageModel;  // trade_page_model.js, and so on
extern const std::string_view tradePageChoose;
extern const std::string_view tradePagePlots;
extern const std::string_view tradePageTables;
extern const std::string_view tradePageCrops;
extern const std::string_view tradePageStart;
extern const std::string_view scalingPageScript;  // scaling_page.js
extern const std::string_view needsPageScript;    // needs_page.js
}  // namespace woodcock

namespace woodcock::tool {

namespace {

/// What is not finite becomes null, and what is not UTF-8 a mark of replacement.
std::string jsonText(const nlohmann::json& report) {
    return report.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

std::string tradePage(const nlohmann::json& report) {
    return makePage({"woodcock trade",
                     {pageChartStyle, tradePageStyle},
                     {{"report", jsonText(report)}},
                     {pageChart, tradePageModel, tradePageChoose, tradePagePlots, tradePageTables,
                      tradePageCrops, tradePageStart}});
}

std::string scalingPage(const nlohmann::json& report) {
    return makePage({"woodcock trade --scaling",
                     {pageChartStyle},
                     {{"report", jsonText(report)}},
                     {pageChart, scalingPageScript}});
}

std::string needsPage(const nlohmann::json& report) {
    return makePage({"woodcock trade --needs",
                     {pageChartStyle},
                     {{"report", jsonText(report)}},
                     {pageChart, needsPageScript}});
}

}  // namespace woodcock::tool
