// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tests/proof/proof.h"

namespace woodcock::tool {

struct VerifyReport {
    std::vector<proof::Case> cases;
    proof::Options options;
    bool complete = true;  ///< false after an interruption
};

/// One line for each case: case, expected, measured, standard error, z, verdict.
std::string casesText(const std::string& check, const std::vector<proof::Case>& cases);
/// How many of each kind, and how many of them pass.
std::string summaryText(const std::vector<proof::Case>& cases);

/// {"version", "full", "seed", ..., "cases": [...]}
std::string reportJson(const VerifyReport& report);
/// A page that needs no other file: tables and plots, in light and dark.
std::string reportHtml(const VerifyReport& report);

}  // namespace woodcock::tool
