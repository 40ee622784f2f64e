// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>

namespace woodcock {

/// Writes `file` whole or not at all: into a temporary file beside it, which is then renamed. On
/// failure the temporary is removed, a former `file` stays as it was, and Error{Failure} names the
/// file and the system's reason.
void writeWholeFile(const std::filesystem::path& file, std::span<const unsigned char> bytes);

/// A file that is written piece by piece: into a temporary beside `target`, which takes the place
/// of `target` at commit() and is removed where that does not come.
class FileInTheMaking {
public:
    explicit FileInTheMaking(const std::filesystem::path& target);
    ~FileInTheMaking();
    FileInTheMaking(const FileInTheMaking&) = delete;
    FileInTheMaking& operator=(const FileInTheMaking&) = delete;

    const std::filesystem::path& temporary() const { return temporary_; }
    void commit();  ///< throws Error{Failure} with the system's reason

private:
    std::filesystem::path target_, temporary_;
};

/// Throws Error{Usage} where writeWholeFile(file) would certainly fail: there is no such directory,
/// it cannot be written, or `file` is a directory itself. Leaves no trace.
void checkWritable(const std::filesystem::path& file);

}  // namespace woodcock
