// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>

namespace woodcock {

/// A new file under a name that nobody can foresee, removed at the end unless it was renamed. While
/// it lives it is locked, by which others know that somebody is at work.
class TemporaryFile {
public:
    /// `mode` as of open(2). Throws std::system_error with the system's reason.
    TemporaryFile(const std::filesystem::path& directory, mode_t mode);
    ~TemporaryFile();
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    const std::filesystem::path& path() const { return path_; }
    int descriptor() const { return descriptor_; }
    /// Gives it its name for good, in place of what has that name. Returns errno, 0 where it went
    /// well.
    int rename(const std::filesystem::path& target);

private:
    std::filesystem::path path_;
    int descriptor_ = -1;
    bool renamed_ = false;
};

/// Removes the temporary files that killed runs of this user left in a directory. What a living
/// process holds stays, and so does what was left before the machine started or by another machine:
/// whether that lives cannot be known.
void removeLeftovers(const std::filesystem::path& directory);

}  // namespace woodcock
