// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include <cmath>

#include "tools/common/json_text.h"
#include "tools/common/output_folders.h"
#include "tools/common/print.h"
#include "tools/trade/parts.h"
#include "tools/trade/report_html.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/trade/scaling.h"

namespace woodcock::tool {
namespace {

using Json = nlohmann::ordered_json;

void printReport(const trade::ScalingReport& report) {
    for (const trade::Curve& curve : report.curves) {
        print("{}\n", curve.name);
        for (const trade::CurveSeries& series : curve.series) {
            const trade::Measured slope = series.slope();
            print("  {}{}\n", series.name,
                  std::isfinite(slope.se)
                      ? fmt::format(": slope {:.3f} +- {:.3f}", slope.value, slope.se)
                      : "");
            for (const trade::CurvePoint& p : series.points)
                print("    {:<12.5g} {:>12.5g} +- {:<10.2g} {}\n", p.x, p.y, p.se,
                      &p == series.points.data() ? curve.yLabel + " over " + curve.xLabel : "");
        }
    }
    for (const trade::CurveTable& table : report.tables) {
        print("{}\n ", table.title);
        for (const std::string& column : table.columns) print(" {:>10}", column);
        print("\n");
        for (const std::vector<double>& row : table.rows) {
            print(" ");
            for (std::size_t i = 0; i < row.size(); ++i)
                print(" {:>{}.4g}", row[i], std::max<std::size_t>(10, table.columns[i].size()));
            print("\n");
        }
    }
    for (const std::string& note : report.notes) print("note: {}\n", note);
}

Json curveJson(const trade::Curve& curve) {
    Json series = Json::array();
    for (const trade::CurveSeries& s : curve.series) {
        Json points = Json::array();
        for (const trade::CurvePoint& p : s.points)
            points.push_back(Json{{"x", p.x}, {"y", p.y}, {"se", p.se}});
        series.push_back(Json{{"name", s.name}, {"points", points}, {"slope", toJson(s.slope())}});
    }
    return {{"name", curve.name},
            {"x", {{"label", curve.xLabel}, {"log", curve.name != "albedo"}}},
            {"y", {{"label", curve.yLabel}, {"log", true}}},
            {"series", series},
            {"note", curve.note}};
}

Json scalingJson(const trade::ScalingReport& report) {
    Json curves = Json::array(), tables = Json::array();
    for (const trade::Curve& curve : report.curves) curves.push_back(curveJson(curve));
    for (const trade::CurveTable& t : report.tables)
        tables.push_back(Json{{"title", t.title}, {"columns", t.columns}, {"rows", t.rows}});
    return {{"woodcock", aboutWoodcock()},
            {"curves", curves},
            {"tables", tables},
            {"notes", report.notes}};
}

std::string scalingCsv(const trade::ScalingReport& report) {
    std::string text = "curve,series,x_label,x,y_label,y,se\n";
    for (const trade::Curve& curve : report.curves)
        for (const trade::CurveSeries& s : curve.series)
            for (const trade::CurvePoint& p : s.points)
                text += fmt::format("{},\"{}\",\"{}\",{},{},{},{}\n", curve.name, s.name,
                                    curve.xLabel, p.x, curve.yLabel, p.y, p.se);
    return text;
}

}  // namespace

void runScaling(double budget, const std::filesystem::path& report, const ReportOptions& reports) {
    prepareReport(report, {"scaling.json", "scaling.csv", "scaling.html"});
    const TempDir scratch;
    const trade::ScalingReport found = trade::measureScaling(
        {.budget = budget, .scratch = scratch.path(), .onProgress = [](auto& what) {
             spdlog::info("{}", what);
         }});
    const Json json = scalingJson(found);
    if (reports.json) printJson(json, 1);
    if (reports.printsText()) printReport(found);
    writeReport(report, {{"scaling.json", jsonText(json, 1) + "\n"},
                         {"scaling.csv", scalingCsv(found)},
                         {"scaling.html", scalingPage(json)}});
}

}  // namespace woodcock::tool
