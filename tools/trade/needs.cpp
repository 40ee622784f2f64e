// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include "tools/common/json_text.h"
#include "tools/common/output_folders.h"
#include "tools/common/print.h"
#include "tools/trade/parts.h"
#include "tools/trade/report_html.h"
#include "woodcock/scene/build.h"
#include "woodcock/trade/needs_cost.h"

namespace woodcock::tool {
namespace {

using Json = nlohmann::ordered_json;

const std::string& nameOf(const trade::NeedCost& c) {
    return trade::needNames[static_cast<std::size_t>(c.need)];
}

/// Without the risk that chance decides: two standard errors beyond the mark on either side.
bool resolved(const trade::NeedCost& c) {
    return std::abs(c.cost().value - trade::NeedCost::leastRatio) > 2 * c.cost().se;
}

std::string verdict(const trade::NeedCost& c) {
    return c.needed ? "needed" : c.earns() ? "earns" : "does not earn";
}

std::string pictures(const trade::NeedCost& c) {
    if (c.needed) return "";
    return c.sameBits ? "same bits"
                      : fmt::format("{:+.1e} +- {:.0e}", c.difference.value, c.difference.se);
}

void printRow(const trade::NeedCost& c) {
    if (c.needed) {
        print("{:<22} {:>11} {:>11} {:>16} {:>16}  needed\n", nameOf(c), "", "", "", "");
    } else {
        print(
            "{:<22} {:>11.3g} {:>11.3g} {:>8.3f} +- {:.3f} {:>8.3f} +- {:.3f}  {}; picture: "
            "{}\n",
            nameOf(c), c.without.value, c.with.value, c.ratio.value, c.ratio.se, c.variance.value,
            c.variance.se, verdict(c), pictures(c));
    }
    std::fflush(stdout);  // what takes long is seen as it comes
}

std::vector<std::string> notesOn(const std::vector<trade::NeedCost>& costs) {
    std::vector<std::string> notes;
    for (const trade::NeedCost& c : costs) {
        if (c.needed) continue;
        if (!resolved(c))
            notes.push_back(
                fmt::format("the budget was too small to tell whether '{}' earns 10 %: {:.3f} "
                            "+- {:.3f} in {} pairs of runs",
                            nameOf(c), c.cost().value, c.cost().se, c.pairs));
        if (!c.sameBits && std::abs(c.difference.value) > 4 * c.difference.se + 1e-5)
            notes.push_back(fmt::format("'{}' changed the picture by {:.2e} +- {:.0e}: a bug",
                                        nameOf(c), c.difference.value, c.difference.se));
    }
    return notes;
}

Json needsJson(const std::string& scene, const std::vector<trade::NeedCost>& costs,
               const std::vector<std::string>& notes) {
    Json rows = Json::array();
    for (const trade::NeedCost& c : costs) {
        Json row{{"need", nameOf(c)}, {"needed", c.needed}};
        if (c.needed) {
            row.update({{"seconds", nullptr}, {"pretended", nullptr}, {"ratio", nullptr}});
        } else {
            row.update({{"seconds", toJson(c.without)},
                        {"pretended", toJson(c.with)},
                        {"ratio", toJson(c.ratio)},
                        {"variance", toJson(c.variance)},
                        {"cost", toJson(c.cost())},
                        {"pairs", c.pairs},
                        {"same_bits", c.sameBits},
                        {"difference", toJson(c.difference)}});
        }
        row["verdict"] = verdict(c);
        rows.push_back(row);
    }
    return {{"woodcock", aboutWoodcock()}, {"scene", scene}, {"rows", rows}, {"notes", notes}};
}

std::string needsCsv(const std::vector<trade::NeedCost>& costs) {
    std::string text =
        "need,needed,seconds,seconds_se,pretended,pretended_se,ratio,ratio_se,variance,variance_se,"
        "pairs,verdict\n";
    for (const trade::NeedCost& c : costs)
        text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", nameOf(c), int{c.needed},
                            c.without.value, c.without.se, c.with.value, c.with.se, c.ratio.value,
                            c.ratio.se, c.variance.value, c.variance.se, c.pairs, verdict(c));
    return text;
}

}  // namespace

void runNeeds(const SceneInput& input, double budget, const std::filesystem::path& report,
              const ReportOptions& reports) {
    checkInput(input);
    prepareReport(report, {"needs.json", "needs.csv", "needs.html"});
    scene::SceneDescription description = parseInput(input);
    scene::LoadedScene loaded = loadAndComplete(description);
    const render::RenderSettings settings = scene::renderSettings(description.render);
    const render::Scene scene = scene::buildScene(description, std::move(loaded));

    bool first = true;
    const auto show = [&](const trade::NeedCost& cost) {
        if (!reports.printsText()) return;
        if (std::exchange(first, false))
            print("{:<22} {:>11} {:>11} {:>16} {:>16}\n", "need", "without [s]", "with [s]",
                  "ratio of times", "of variances");
        printRow(cost);
    };
    const auto costs = trade::needsCost(scene, settings, {.budget = budget, .onResult = show});
    const std::vector<std::string> notes = notesOn(costs);
    const std::string name = input.files.front().filename().string();
    const Json json = needsJson(name, costs, notes);
    if (reports.json) printJson(json, 1);
    if (reports.printsText())
        for (const std::string& note : notes) print("note: {}\n", note);
    writeReport(report, {{"needs.json", jsonText(json, 1) + "\n"},
                         {"needs.csv", needsCsv(costs)},
                         {"needs.html", needsPage(json)}});
}

}  // namespace woodcock::tool
