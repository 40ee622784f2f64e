// SPDX-License-Identifier: Apache-2.0
// `woodcock verify`, by the program that holds the proof: woodcock-verify, in the same folder.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "tools/common/command.h"
#include "tools/verify/purpose.h"
#include "woodcock/base/error.h"

namespace woodcock::tool {

namespace {

std::filesystem::path verifyProgram() {
    return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "woodcock-verify";
}

/// Takes the place of this process.
[[noreturn]] void launch(std::vector<std::string> arguments) {
    const std::string program = verifyProgram().string();
    if (!std::filesystem::exists(program))
        throw failure(
            "woodcock verify needs the program {}, which has not been built; this builds it: {}",
            program, WOODCOCK_BUILD_VERIFY);
    arguments.insert(arguments.begin(), {program, "verify"});
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    execv(program.c_str(), words.data());
    throw failure("cannot start {}: {}", program, std::strerror(errno));
}

CLI::App& addTo(CLI::App& app, const std::string&) {
    CLI::App& command = *app.add_subcommand("verify", verifyPurpose);
    command.set_help_flag();  // all words are for the other program
    command.prefix_command();
    command.formatter_fn([](const CLI::App*, std::string, CLI::AppFormatMode) -> std::string {
        launch({"--help"});
    });
    command.callback([&command] { launch(command.remaining()); });
    return command;
}

}  // namespace

extern const Command verifyCommand;
const Command verifyCommand{addTo};

}  // namespace woodcock::tool
