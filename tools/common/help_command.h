// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace woodcock::tool {

/// `woodcock version` and `woodcock help`, as many expect them beside --version and --help, and
/// --version for the program and each command. `programHelp` is read when help is asked for.
void addHelpCommands(CLI::App& app, const std::string& programHelp);

}  // namespace woodcock::tool
