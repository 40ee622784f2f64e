// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>

namespace woodcock {

/// A new file with an unpredictable name. It is removed at the end unless it was renamed. While it
/// exists it is locked, so that other processes see that it is in use.
class TemporaryFile {
public:
    /// `mode` as of open(2). Throws std::system_error with the system's reason.
    TemporaryFile(const std::filesystem::path& directory, mode_t mode);
    ~TemporaryFile();
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    const std::filesystem::path& path() const { return path_; }
    int descriptor() const { return descriptor_; }
    /// Gives the file its final name, and replaces what had that name. Returns errno, 0 where it
    /// went well.
    int rename(const std::filesystem::path& target);

private:
    std::filesystem::path path_;
    int descriptor_ = -1;
    bool renamed_ = false;
};

/// Removes the temporary files that killed runs of this user left in a directory. Files stay that a
/// running process holds, that are older than the machine's start, or that another machine made:
/// whether their process still runs cannot be known.
void removeLeftovers(const std::filesystem::path& directory);

}  // namespace woodcock
