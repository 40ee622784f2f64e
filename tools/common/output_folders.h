// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

namespace woodcock::tool {

/// The option that sets `make` of prepareFolder().
CLI::Option* addMkdir(CLI::App& command, bool& make);

/// Sees to it that the folder that `file` is to be written into exists: makes it, where `make` says
/// so, with those that it lies in. Throws Error{Usage} otherwise, and where that is impossible.
/// `place`: where the file was named; may be empty. Nothing for an empty name and for "-".
void prepareFolder(const std::filesystem::path& file, bool make, const std::string& place = "");

}  // namespace woodcock::tool
