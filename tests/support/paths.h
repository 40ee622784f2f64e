// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace woodcock::test {

std::filesystem::path program();    ///< the `woodcock` program of this build
std::filesystem::path renderEachProgram();  ///< tests/programs/render_each
std::filesystem::path sourceDir();  ///< top of the source tree

/// Reference data that is not part of the repository, beside it; may be missing. A test that needs
/// it says so: `if (!exists(sharedDir() / "...")) GTEST_SKIP() << "no ...";`
std::filesystem::path sharedDir();

/// A directory of its own for each test, removed with its contents at the end.
class TempDir {
public:
    TempDir();
    ~TempDir();
    TempDir(const TempDir&) = delete;
    TempDir& operator=(const TempDir&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

private:
    std::filesystem::path path_;
};

std::string readText(const std::filesystem::path& file);
void writeText(const std::filesystem::path& file, const std::string& text);

}  // namespace woodcock::test
