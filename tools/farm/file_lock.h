// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <utility>

namespace woodcock::tool::farm {

/// A file that one process holds, on whatever machine, with the processes that it starts meanwhile:
/// while one of them lives, it stays held. It is free again when they end, however that comes.
class FileLock {
public:
    /// Absent where another holds it. Throws Error{Failure} where the file system has no locks.
    static std::optional<FileLock> tryToHold(const std::filesystem::path& file);
    /// Whether somebody holds it. A file that is not there is held by nobody.
    static bool isHeld(const std::filesystem::path& file);

    FileLock(FileLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
    FileLock& operator=(FileLock&&) = delete;
    ~FileLock();

private:
    explicit FileLock(int descriptor) : descriptor_(descriptor) {}
    int descriptor_;
};

}  // namespace woodcock::tool::farm
