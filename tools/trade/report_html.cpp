// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>
#include <string_view>

#include "tools/common/json_text.h"
#include "tools/pages/page.h"
#include "tools/trade/report_html.h"

namespace woodcock::tool {

// Of ../pages and page/, see their CMakeLists.txt.
extern const std::string_view pageChart, pageChartRows, pageChartStyle;
extern const std::string_view tradePageStyle, tradePageAnswers, tradePageWords, tradePageChoose,
    tradePagePlots, tradePageTables, tradePageCrops, tradePageStart;
extern const std::string_view scalingPageScript, needsPageScript;

std::string tradePage(const nlohmann::json& report, const nlohmann::json& answers) {
    return makePage({"woodcock trade",
                     {pageChartStyle, tradePageStyle},
                     {{"report", jsonText(report, -1)}, {"answers", jsonText(answers, -1)}},
                     {pageChart, pageChartRows, tradePageAnswers, tradePageWords, tradePageChoose,
                      tradePagePlots, tradePageTables, tradePageCrops, tradePageStart}});
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
