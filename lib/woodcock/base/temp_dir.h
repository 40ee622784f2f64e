// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace woodcock {

/// A directory of its own, under a name that nobody can foresee. It is removed at the end, with all
/// that is in it.
class TempDir {
public:
    TempDir();  ///< throws Error{Failure} with the system's reason
    ~TempDir();
    TempDir(const TempDir&) = delete;
    TempDir& operator=(const TempDir&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    std::string string() const { return path_.string(); }

private:
    std::filesystem::path path_;
};

/// Reads or writes a whole file, for proofs and tests. They throw Error{Failure}, which names the
/// file. What users write goes through writeWholeFile().
std::string readText(const std::filesystem::path& file);
void writeText(const std::filesystem::path& file, const std::string& text);

}  // namespace woodcock
