// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "woodcock/trade/curve.h"

namespace woodcock::trade {

struct ScalingReport {
    std::vector<Curve> curves;
    std::vector<CurveTable> tables;
    std::vector<std::string> notes;  ///< measurements for which the budget was too small
};

struct ScalingOptions {
    double budget = 600;                 ///< seconds
    std::filesystem::path scratch = {};  ///< a directory for baked volumes, which are removed again
    std::function<void(const std::string&)> onProgress = {};
};

/// With less than this all curves are noise.
inline constexpr double leastScalingBudget = 10;

/// How the cost of a sample grows with voxels, optical depth, albedo, g, overlapping volumes, the
/// size of majorant cells and threads; load time and memory beside OpenVDB's own; and the machine's
/// limit, random lookups in a field, compared with the collisions of a render. The points of a
/// curve are measured alternately, in processor time of one thread. Throws Error{Usage} where the
/// budget is below the least.
ScalingReport measureScaling(const ScalingOptions& options);

}  // namespace woodcock::trade
