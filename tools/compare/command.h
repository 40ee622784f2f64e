// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/common/report_options.h"
#include "woodcock/compare/comparison.h"

namespace woodcock::tool {

struct CompareOptions {
    std::vector<PictureSource> sources;
    CompareSettings settings;
    std::vector<std::string> failAbove;  ///< "rmse=0.01", "differ"
    std::filesystem::path report;        ///< a directory; empty: none
    std::filesystem::path ocio;          ///< empty: $OCIO or the shipped one
    ReportOptions reports;
};

/// Compares, prints and writes the report, whose directory it makes; notes go to the log. Returns
/// the exit code: 1 where `failAbove` says so. Throws Error.
int runCompare(const CompareOptions& options);

}  // namespace woodcock::tool
