// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace woodcock {

/// A regular file that is open for reading. Pipes, devices and directories are refused at once:
/// reading a pipe could wait forever, and a device may have no end.
class RegularFile {
public:
    /// `what` names the kind of file in messages: "cannot read image 'a.png': it is a pipe".
    /// Throws Error{Input}.
    RegularFile(const std::filesystem::path& file, std::string_view what);
    ~RegularFile();
    RegularFile(const RegularFile&) = delete;
    RegularFile& operator=(const RegularFile&) = delete;

    std::uint64_t size() const { return size_; }
    /// `bytes` from `offset` on, fewer at the file's end. Throws Error{Input}.
    std::string read(std::uint64_t offset, std::size_t bytes) const;

    /// "cannot read image 'a.png': <reason>"
    class Error unreadable(std::string_view reason) const;

private:
    std::filesystem::path file_;
    std::string what_;
    int descriptor_ = -1;
    std::uint64_t size_ = 0;
};

/// All of a regular file of at most `mostBytes`. Throws Error{Input}.
std::string readRegularFile(const std::filesystem::path& file, std::string_view what,
                            std::uint64_t mostBytes);

}  // namespace woodcock
