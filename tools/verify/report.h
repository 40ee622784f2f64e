// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "woodcock/proof/proof.h"

namespace woodcock::tool {

/// What a check took.
struct CheckTime {
    proof::Kind kind{};
    std::string name;
    double seconds = 0;
};

struct VerifyReport {
    std::vector<proof::Case> cases{};
    proof::Options options{};
    std::vector<CheckTime> times{};
    std::string only{};    ///< what the names of the checks were asked to contain
    std::string date{};    ///< of the start, as ISO 8601 has it
    bool complete = true;  ///< false after an interruption
};

/// One line for each case: case, expected, measured, standard error, z, verdict. Long names have a
/// line of their own.
std::string casesText(const std::string& check, const std::vector<proof::Case>& cases);
/// How many of each kind, how many of them pass, and how long they took.
std::string summaryText(const VerifyReport& report);

/// {"version", "build", "full", "seed", ..., "cases": [...]}; numbers that are not finite are null.
std::string reportJson(const VerifyReport& report);
/// A page that needs no other file: tables and plots, in light and dark.
std::string reportHtml(const VerifyReport& report);

}  // namespace woodcock::tool
