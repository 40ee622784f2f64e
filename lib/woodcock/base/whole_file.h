// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include "woodcock/base/temporary_file.h"

namespace woodcock {

// How outputs come to the place that they are named for. A regular file is replaced as a whole, by
// a temporary file beside it that takes its name, and its owner, group, permissions and access list
// stay. A symbolic link stays, and what it leads to is replaced. Pipes, character devices and open
// descriptors (/dev/stdout) are written into. Of a file with several names (hard links) only the
// named one gets the new content.

/// Writes `file` whole or not at all. On failure a former `file` stays as it was, and
/// Error{Failure} names the file and the system's reason. What a pipe or a device took before that
/// cannot be taken back. Waits ten seconds for the reader of a pipe.
void writeWholeFile(const std::filesystem::path& file, std::span<const unsigned char> bytes);
void writeWholeFile(const std::filesystem::path& file, std::string_view text);

/// A file that is written piece by piece: into a temporary, which takes the place of `target` at
/// commit() and is removed where that does not come.
class FileInTheMaking {
public:
    /// Throws Error{Failure} with the system's reason.
    explicit FileInTheMaking(const std::filesystem::path& target);
    ~FileInTheMaking();
    FileInTheMaking(const FileInTheMaking&) = delete;
    FileInTheMaking& operator=(const FileInTheMaking&) = delete;

    /// An empty regular file.
    const std::filesystem::path& temporary() const { return temporary_->path(); }
    void commit();  ///< throws Error{Failure} with the system's reason

private:
    struct Target;
    std::filesystem::path named_;
    std::unique_ptr<const Target> target_;
    std::unique_ptr<TemporaryFile> temporary_;

    friend void writeWholeFile(const std::filesystem::path&, std::span<const unsigned char>);
    friend void checkWritable(const std::filesystem::path&);
};

/// Throws Error{Usage} where writeWholeFile(file) would certainly fail: there is no such directory,
/// it cannot be written, or `file` is a directory itself, write-protected, a block device or a
/// socket. Leaves no trace, and clears up what killed runs left beside it.
void checkWritable(const std::filesystem::path& file);

/// Whether both names lead to the same file, by symbolic and hard links too.
bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b);

/// Throws Error{Usage} where one of `written` is one of `read`, or stands twice in `written`.
/// Pipes and devices may. Empty paths are none.
void refuseOverwriting(std::span<const std::filesystem::path> written,
                       std::span<const std::filesystem::path> read);

/// Bytes of a regular file, 0 where it is none: what was written may be a device.
std::uint64_t bytesOfFile(const std::filesystem::path& file);

}  // namespace woodcock
