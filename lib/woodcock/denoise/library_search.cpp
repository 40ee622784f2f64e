// SPDX-License-Identifier: Apache-2.0
#include "woodcock/denoise/library_search.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <system_error>

#include "woodcock/denoise/denoiser.h"

namespace woodcock::denoise {

namespace fs = std::filesystem;

const std::string libraryName = "libOpenImageDenoise.so.2";

namespace {

/// Empty where it is not set.
std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

bool isThere(const fs::path& path) {
    std::error_code ignored;
    return fs::exists(path, ignored);
}

/// The folders python3* of `prefix`/lib, sorted.
std::vector<fs::path> pythonFolders(const fs::path& prefix) {
    std::vector<fs::path> folders;
    std::error_code error;
    for (fs::directory_iterator entry(prefix / "lib", error), end; !error && entry != end;
         entry.increment(error))
        if (entry->path().filename().string().starts_with("python3"))
            folders.push_back(entry->path());
    std::sort(folders.begin(), folders.end());
    return folders;
}

}  // namespace

fs::path namedLibrary() { return environment(libraryVariable); }

fs::path libraryIn(const fs::path& folder) {
    for (const char* below : {"", "lib", "oidn/lib", "pyoidn/oidn/lib"})
        if (const fs::path file = folder / below / libraryName; isThere(file)) return file;
    return {};
}

std::vector<fs::path> prefixes() {
    std::vector<fs::path> all;
    const auto add = [&](const fs::path& prefix) {
        if (prefix.is_absolute() && std::find(all.begin(), all.end(), prefix) == all.end())
            all.push_back(prefix);
    };
    add(environment("VIRTUAL_ENV"));
    add(environment("CONDA_PREFIX"));
    std::istringstream path(environment("PATH"));
    for (std::string folder; std::getline(path, folder, ':');)
        if (isThere(fs::path(folder) / "python3"))
            add((fs::path(folder) / "").parent_path().parent_path());
    if (const std::string home = environment("HOME"); !home.empty()) add(fs::path(home) / ".local");
    add("/usr/local");
    add("/usr");
    return all;
}

std::vector<fs::path> installedLibraries() {
    std::vector<fs::path> files;
    const auto add = [&](const fs::path& file) {
        if (isThere(file)) files.push_back(file);
    };
    for (const fs::path& prefix : prefixes()) {
        add(prefix / "lib" / libraryName);
        for (const fs::path& python : pythonFolders(prefix))
            for (const char* packages : {"site-packages", "dist-packages"})
                add(python / packages / "pyoidn/oidn/lib" / libraryName);
    }
    return files;
}

}  // namespace woodcock::denoise
