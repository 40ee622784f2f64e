// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace woodcock::tool {

// One file per subcommand. Each adds its options and the callback that does the work; a callback
// reports what goes wrong by throwing, and another exit code than 0 by throwing CLI::RuntimeError.

CLI::App& addBakeCommand(CLI::App& app);
CLI::App& addCompareCommand(CLI::App& app, const std::string& commandLine);
CLI::App& addConvertCommand(CLI::App& app);
CLI::App& addInfoCommand(CLI::App& app);
// Of the proof; in `woodcock`, of what calls the program that holds it (see verify_launcher.cpp).
CLI::App& addVerifyCommand(CLI::App& app);
inline const std::string verifyPurpose =
    "Hold this build on this machine against closed forms, published tables and properties that "
    "any volume has";
// `commandLine` goes into the images' headers.
CLI::App& addCyclesCommand(CLI::App& app, const std::string& commandLine);
CLI::App& addRenderCommand(CLI::App& app, const std::string& commandLine);
CLI::App& addTradeCommand(CLI::App& app, const std::string& commandLine);

}  // namespace woodcock::tool
