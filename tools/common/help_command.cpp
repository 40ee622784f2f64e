// SPDX-License-Identifier: Apache-2.0
#include "tools/common/help_command.h"

#include <memory>
#include <vector>

#include "tools/common/about.h"
#include "tools/common/print.h"
#include "woodcock/base/error.h"
#include "woodcock/base/nearest_name.h"

namespace woodcock::tool {

namespace {

void addVersionFlags(CLI::App& app) {
    app.set_version_flag("-V,--version", aboutProgram,
                         "Print the versions of the program and its libraries");
    for (CLI::App* command : app.get_subcommands(nullptr))
        command->set_version_flag("-V,--version", aboutProgram)->group("");
}

}  // namespace

void addHelpCommands(CLI::App& app, const std::string& programHelp) {
    app.add_subcommand("version", "Print the versions of the program and of its libraries")
        ->callback([] { print("{}\n", aboutProgram()); });
    CLI::App* const help =
        app.add_subcommand("help", "Print the help of the program or of a command");
    const auto name = std::make_shared<std::string>();
    help->add_option("COMMAND", *name, "The command whose help to print. Without it: the program's")
        ->type_name("");
    help->callback([&app, &programHelp, name] {
        std::vector<std::string> known;
        for (const CLI::App* command : app.get_subcommands(nullptr)) {
            known.push_back(command->get_name());
            if (known.back() == *name) return print("{}", command->help("woodcock"));
        }
        if (!name->empty())
            throw usageError("woodcock help: unknown command '{}'{}", *name,
                             suggestName(*name, "known", known));
        print("{}", programHelp);
    });
    addVersionFlags(app);
}

}  // namespace woodcock::tool
