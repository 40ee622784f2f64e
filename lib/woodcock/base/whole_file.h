// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include "woodcock/base/temporary_file.h"

namespace woodcock {

// How outputs are written. A regular file is replaced as a whole: a temporary file beside it takes
// its name. Its owner, group, permissions and access list stay. A symbolic link stays, and its
// target is replaced. Pipes, character devices and open descriptors (/dev/stdout) are written into.
// If a file has several names (hard links), only the given name gets the new content.

/// Writes `file` whole or not at all. On failure a former `file` stays as it was, and
/// Error{Failure} names the file and the system's reason. Bytes that a pipe or a device took before
/// that are not taken back. Waits up to ten seconds for the reader of a pipe.
void writeWholeFile(const std::filesystem::path& file, std::span<const unsigned char> bytes);
void writeWholeFile(const std::filesystem::path& file, std::string_view text);

/// A file that is written piece by piece, into a temporary file. At commit() that takes the place
/// of `target`; without commit() it is removed.
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
/// socket. Leaves no trace, and removes what killed runs left beside it.
void checkWritable(const std::filesystem::path& file);

/// Whether both names lead to the same file, also through symbolic and hard links.
bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b);

/// Throws Error{Usage} where one of `written` is also one of `read`, or is in `written` twice.
/// Pipes and devices are allowed. Empty paths are ignored.
void refuseOverwriting(std::span<const std::filesystem::path> written,
                       std::span<const std::filesystem::path> read);

/// Bytes of a regular file. 0 for anything else: an output may be a device.
std::uint64_t bytesOfFile(const std::filesystem::path& file);

}  // namespace woodcock
