// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/farm/job.h"
#include "tools/render/options.h"

namespace woodcock::tool::farm {

/// What the command line of `woodcock farm submit` says: all that a render's may say, and more.
struct SubmitOptions {
    RenderOptions render;
    std::filesystem::path folder;  ///< empty: after the input, in the working directory
    std::optional<int> parts, retries, cpus, atOnce, tasksPerElement;
    bool keepParts = false, dryRun = false;
    std::string program, partition, account, time, memory;
    std::vector<std::string> sbatch;

    void addTo(CLI::App& command);
};

/// Checks all that can be known before anything is drawn, and writes the folder of a new job.
/// `command`: where addTo() was called, after it was parsed. Throws Error{Usage} or Error{Input},
/// or ends as the render that chooses what is open; then there is no folder.
Job makeJob(const SubmitOptions& options, const CLI::App& command);

}  // namespace woodcock::tool::farm
