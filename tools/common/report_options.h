// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "tools/common/progress.h"

namespace woodcock::tool {

/// What a command says while it works and at its end, and where. Every command has these options.
struct ReportOptions {
    bool quiet = false, json = false;
    std::string progress = "auto";
    std::optional<std::string> logLevel;

    /// `jsonHelp` says what --json prints.
    void addTo(CLI::App& command, const std::string& jsonHelp);
    /// Sets up the log, which must come before all that reports; returns how to show progress.
    /// Throws Error{Usage} where the options contradict each other.
    ProgressStyle start() const;
    /// Whether stdout gets tables for people: neither with --quiet nor with --json.
    bool printsText() const { return !quiet && !json; }
};

}  // namespace woodcock::tool
