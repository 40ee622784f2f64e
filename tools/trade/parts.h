// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/common/report_options.h"
#include "tools/common/scene_input.h"
#include "woodcock/trade/timing.h"

namespace woodcock::tool {

// What `woodcock trade` does beside weighing candidates: a file for each.

/// --needs: what unneeded features would cost this scene. A table or JSON on stdout; needs.json and
/// needs.csv in the directory `report` unless that is empty.
void runNeeds(const SceneInput& input, double budget, const std::filesystem::path& report,
              const ReportOptions& reports);

/// --scaling: how the cost grows. Likewise; scaling.json and scaling.csv.
void runScaling(double budget, const std::filesystem::path& report, const ReportOptions& reports);

nlohmann::ordered_json toJson(
    const trade::Measured& m);  ///< {"value", "se"}; null where not finite
nlohmann::ordered_json aboutWoodcock();

}  // namespace woodcock::tool
