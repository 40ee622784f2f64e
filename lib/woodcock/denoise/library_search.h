// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace woodcock::denoise {

/// As the loader calls it: "libOpenImageDenoise.so.2".
extern const std::string libraryName;

/// What $WOODCOCK_OIDN names; empty: it is not set.
std::filesystem::path namedLibrary();

/// The library in a folder: in itself, or where pyoidn and archives of Open Image Denoise have it.
/// Empty: nowhere.
std::filesystem::path libraryIn(const std::filesystem::path& folder);

/// Folders below which environments of Python and of conda lie, in the order of the search, none
/// twice: $VIRTUAL_ENV, $CONDA_PREFIX, those of each python3 of $PATH, ~/.local, /usr/local, /usr.
std::vector<std::filesystem::path> prefixes();

/// The libraries that are there below prefixes(): lib/libOpenImageDenoise.so.2, and that of pyoidn
/// in lib/python3*/site-packages or dist-packages.
std::vector<std::filesystem::path> installedLibraries();

}  // namespace woodcock::denoise
