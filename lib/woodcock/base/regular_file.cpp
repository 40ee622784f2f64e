// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/regular_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "woodcock/base/error.h"

namespace woodcock {

namespace {

std::string_view kindOf(mode_t mode) {
    if (S_ISDIR(mode)) return "it is a directory";
    if (S_ISFIFO(mode)) return "it is a pipe; expected a regular file";
    if (S_ISSOCK(mode)) return "it is a socket; expected a regular file";
    return "it is a device; expected a regular file";
}

}  // namespace

RegularFile::RegularFile(const std::filesystem::path& file, std::string_view what)
    : file_(file), what_(what) {
    struct stat status {};
    // Checked before it is opened: opening a device may already start it.
    if (::stat(file.c_str(), &status) != 0)
        throw unreadable(errno == ENOENT || errno == ENOTDIR
                             ? "there is no such file"
                             : std::generic_category().message(errno));
    if (!S_ISREG(status.st_mode)) throw unreadable(kindOf(status.st_mode));
    descriptor_ = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (descriptor_ < 0) throw unreadable(std::generic_category().message(errno));
    // The name may lead to another file by now.
    if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
        ::close(descriptor_);
        throw unreadable("it was replaced while it was opened");
    }
    size_ = static_cast<std::uint64_t>(status.st_size);
}

RegularFile::~RegularFile() { ::close(descriptor_); }

std::string RegularFile::read(std::uint64_t offset, std::size_t bytes) const {
    if (offset >= size_) return {};
    std::string text(static_cast<std::size_t>(std::min<std::uint64_t>(bytes, size_ - offset)), 0);
    for (std::size_t got = 0; got < text.size();) {
        const ssize_t more = ::pread(descriptor_, text.data() + got, text.size() - got,
                                     static_cast<off_t>(offset + got));
        if (more < 0 && errno == EINTR) continue;
        if (more < 0) throw unreadable(std::generic_category().message(errno));
        if (more == 0) text.resize(got);
        got += static_cast<std::size_t>(more);
    }
    return text;
}

Error RegularFile::unreadable(std::string_view reason) const {
    return inputError("cannot read {} '{}': {}", what_, file_.string(), reason);
}

std::string readRegularFile(const std::filesystem::path& file, std::string_view what,
                            std::uint64_t mostBytes) {
    const RegularFile open(file, what);
    if (open.size() > mostBytes)
        throw open.unreadable(fmt::format("it has {} bytes; such a file may have {} at most",
                                          open.size(), mostBytes));
    return open.read(0, static_cast<std::size_t>(open.size()));
}

}  // namespace woodcock
