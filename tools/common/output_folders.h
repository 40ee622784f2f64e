// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace woodcock::tool {

/// The option that sets `make` of prepareFolder().
CLI::Option* addMkdir(CLI::App& command, bool& make);

/// Sees to it that the folder that `file` is to be written into exists: makes it, where `make` says
/// so, with those that it lies in. Throws Error{Usage} otherwise, and where that is impossible.
/// `place`: where the file was named; may be empty. Nothing for an empty name and for "-".
void prepareFolder(const std::filesystem::path& file, bool make, const std::string& place = "");

/// prepareFolder(), and throws Error{Usage} where the file cannot be written or its name is a
/// pattern for frames. Nothing for an empty name and for "-".
void prepareOutput(const std::filesystem::path& file, bool make, const std::string& place);

// The folder of --report, which is made where it is missing. Nothing happens for an empty name.

/// Throws Error{Usage} where the folder cannot be made, or one of these files not written into it.
void prepareReport(const std::filesystem::path& folder, const std::vector<std::string>& names);

/// Names and texts of a report's files. The log tells what was written. Throws Error{Failure}.
void writeReport(const std::filesystem::path& folder,
                 const std::vector<std::pair<std::string, std::string>>& files);

}  // namespace woodcock::tool
