// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace woodcock::tool {

/// A command of the program. The folder tools/NAME defines one: `const Command NAMECommand`.
struct Command {
    /// Adds the command to the program: its options, and the callback that does the work.
    /// `commandLine` is what was called; images' headers keep it. A callback tells of what goes
    /// wrong by throwing Error, and ends with a code of its own by endWith().
    CLI::App& (*add)(CLI::App& app, const std::string& commandLine);
};

/// All commands, in the order of the help. tools/CMakeLists.txt lists them.
std::vector<Command> allCommands();

}  // namespace woodcock::tool
