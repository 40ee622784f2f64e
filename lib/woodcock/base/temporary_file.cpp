// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/temporary_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <string>
#include <system_error>

namespace woodcock {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view ending = ".part";
constexpr std::size_t randomDigits = 16;

/// The prefix of temporary files that this machine has made since it was started. Files of other
/// machines have another one: their locks on a shared disk may be invisible here. Empty where the
/// prefix is not known.
const std::string& ourBeginning() {
    static const std::string beginning = [] {
        std::string boot;
        std::ifstream("/proc/sys/kernel/random/boot_id") >> boot;
        return boot.size() < 8 ? std::string() : ".woodcock-" + boot.substr(0, 8) + "-";
    }();
    return beginning;
}

std::string newName() {
    std::uint64_t number = 0;
    if (getrandom(&number, sizeof number, 0) != sizeof number)
        throw std::system_error(errno, std::generic_category());
    const std::string& beginning = ourBeginning();
    return fmt::format("{}{:0{}x}{}", beginning.empty() ? ".woodcock-" : beginning, number,
                       randomDigits, ending);
}

bool isOurs(const std::string& name) {
    const std::string& beginning = ourBeginning();
    return !beginning.empty() && name.size() == beginning.size() + randomDigits + ending.size() &&
           name.starts_with(beginning) && name.ends_with(ending) &&
           name.find_first_not_of("0123456789abcdef", beginning.size()) ==
               beginning.size() + randomDigits;
}

/// A lock that nobody holds means that its process is gone.
void removeIfDead(const fs::path& file) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return;
    struct stat status {};
    if (::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) &&
        status.st_uid == ::geteuid() && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0)
        ::unlink(file.c_str());
    ::close(descriptor);
}

}  // namespace

TemporaryFile::TemporaryFile(const fs::path& directory, mode_t mode) {
    constexpr int mostTries = 100;
    for (int i = 0; i < mostTries; ++i) {
        path_ = directory / newName();
        descriptor_ =
            ::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
        if (descriptor_ < 0 && errno == EEXIST) continue;
        if (descriptor_ < 0) throw std::system_error(errno, std::generic_category());
        // Another process may have removed the file before it was locked. File systems without
        // locks need none: nothing is removed there.
        struct stat status {};
        const bool locked = ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
        if (locked && ::fstat(descriptor_, &status) == 0 && status.st_nlink > 0) return;
        ::unlink(path_.c_str());
        ::close(descriptor_);
    }
    throw std::system_error(EEXIST, std::generic_category());
}

TemporaryFile::~TemporaryFile() {
    if (!renamed_) ::unlink(path_.c_str());
    ::close(descriptor_);
}

int TemporaryFile::rename(const fs::path& target) {
    if (std::rename(path_.c_str(), target.c_str()) != 0) return errno;
    renamed_ = true;
    return 0;
}

void removeLeftovers(const fs::path& directory) {
    std::error_code error;
    for (fs::directory_iterator it(directory, error), end; !error && it != end; it.increment(error))
        if (isOurs(it->path().filename().string())) removeIfDead(it->path());
}

}  // namespace woodcock
