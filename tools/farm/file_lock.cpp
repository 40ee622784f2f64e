// SPDX-License-Identifier: Apache-2.0
#include "tools/farm/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "woodcock/base/error.h"

namespace woodcock::tool::farm {

namespace {

/// Whether the lock could be had now.
bool lockNow(int descriptor, int kind, const std::filesystem::path& file) {
    if (flock(descriptor, kind | LOCK_NB) == 0) return true;
    if (errno == EWOULDBLOCK) return false;
    throw failure("cannot lock '{}': {}; a job's folder needs a file system with locks (flock)",
                  file.string(), std::strerror(errno));
}

}  // namespace

std::optional<FileLock> FileLock::tryToHold(const std::filesystem::path& file) {
    // No O_CLOEXEC: a render goes on where its parent is killed, and nobody else may draw the same.
    const int descriptor = open(file.c_str(), O_RDWR | O_CREAT, 0666);
    if (descriptor < 0) throw failure("cannot write '{}': {}", file.string(), std::strerror(errno));
    FileLock lock(descriptor);
    if (!lockNow(descriptor, LOCK_EX, file)) return {};
    return lock;
}

bool FileLock::isHeld(const std::filesystem::path& file) {
    const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return false;
    const FileLock closes(descriptor);
    return !lockNow(descriptor, LOCK_SH, file);
}

// Not unlocked: what it started may hold it still.
FileLock::~FileLock() {
    if (descriptor_ >= 0) close(descriptor_);
}

}  // namespace woodcock::tool::farm
