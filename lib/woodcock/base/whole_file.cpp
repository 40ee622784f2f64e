// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/whole_file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "woodcock/base/error.h"

namespace woodcock {

namespace fs = std::filesystem;

/// What is behind a name.
struct FileInTheMaking::Target {
    enum class Kind { Nothing, Regular, Stream, Descriptor, Other };

    fs::path file;  ///< behind all symbolic links
    Kind kind = Kind::Nothing;
    int descriptor = -1;    ///< of Kind::Descriptor
    struct stat status {};  ///< where there is something

    explicit Target(const fs::path& name);
    bool isReplaced() const { return kind == Kind::Nothing || kind == Kind::Regular; }
};

namespace {

fs::path directoryOf(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

std::string reasonOf(int error) { return std::generic_category().message(error); }

/// Of "/proc/self/fd/1", which "/dev/stdout" leads to: 1. Elsewhere: -1.
int descriptorNamed(const fs::path& file) {
    const std::string name = file.filename().string();
    int number = -1;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error != std::errc() || end != name.data() + name.size() || number < 0) return -1;
    std::error_code ignored;
    const fs::path ours = fs::canonical("/proc/self/fd", ignored);
    return !ours.empty() && fs::canonical(directoryOf(file), ignored) == ours ? number : -1;
}

/// A descriptor of a pipe or device that takes bytes, or -1 and errno.
int openStream(const fs::path& file) {
    constexpr std::chrono::milliseconds pause(20), patience(10000);
    // Opening a pipe without a reader would wait forever.
    for (auto waited = std::chrono::milliseconds::zero();; waited += pause) {
        const int descriptor = ::open(file.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
        if (descriptor >= 0) {
            ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
            return descriptor;
        }
        if (errno != ENXIO || waited >= patience) return -1;
        std::this_thread::sleep_for(pause);
    }
}

/// Zero, or the errno of what failed.
int writeAll(int descriptor, std::span<const unsigned char> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written >= 0) {
            bytes = bytes.subspan(static_cast<std::size_t>(written));
        } else if (errno == EAGAIN) {
            pollfd ready{descriptor, POLLOUT, 0};
            ::poll(&ready, 1, -1);
        } else if (errno != EINTR) {
            return errno;
        }
    }
    return 0;
}

int closeAfter(int descriptor, int error) {
    const int closeError = ::close(descriptor) == 0 ? 0 : errno;
    return error ? error : closeError;
}

int copyAll(int from, int to) {
    std::vector<unsigned char> block(1 << 20);
    for (off_t at = 0;;) {
        const ssize_t read = ::pread(from, block.data(), block.size(), at);
        if (read < 0 && errno == EINTR) continue;
        if (read < 0) return errno;
        if (read == 0) return 0;
        if (const int error = writeAll(to, {block.data(), static_cast<std::size_t>(read)}))
            return error;
        at += read;
    }
}

/// Gives a file the owner, group, permissions and access list of the file that it replaces, as far
/// as the system lets this user.
void keepAttributes(int descriptor, const fs::path& former, const struct stat& status) {
    if (::fchown(descriptor, status.st_uid, status.st_gid) != 0 &&
        ::fchown(descriptor, static_cast<uid_t>(-1), status.st_gid) != 0)
        errno = 0;
    ::fchmod(descriptor, status.st_mode & 0777);
    constexpr const char* accessList = "system.posix_acl_access";
    std::vector<char> list(4096);
    const ssize_t size = ::getxattr(former.c_str(), accessList, list.data(), list.size());
    if (size > 0)
        ::fsetxattr(descriptor, accessList, list.data(), static_cast<std::size_t>(size), 0);
}

}  // namespace

FileInTheMaking::Target::Target(const fs::path& name) : file(name) {
    constexpr int mostLinks = 40;
    for (int i = 0; i < mostLinks; ++i) {
        if (::lstat(file.c_str(), &status) != 0) return;
        if (!S_ISLNK(status.st_mode)) {
            kind = S_ISREG(status.st_mode)                               ? Kind::Regular
                   : S_ISFIFO(status.st_mode) || S_ISCHR(status.st_mode) ? Kind::Stream
                                                                         : Kind::Other;
            return;
        }
        descriptor = descriptorNamed(file);
        if (descriptor >= 0) {
            kind = Kind::Descriptor;
            return;
        }
        std::error_code error;
        const fs::path next = fs::read_symlink(file, error);
        if (error) return;
        file = next.is_absolute() ? next : directoryOf(file) / next;
    }
    throw usageError("cannot write '{}': {}", name.string(), reasonOf(ELOOP));
}

FileInTheMaking::FileInTheMaking(const fs::path& target)
    : named_(target), target_(std::make_unique<Target>(target)) {
    // Streams take their bytes in order, but some formats are not written in order.
    try {
        const fs::path directory =
            target_->isReplaced() ? directoryOf(target_->file) : fs::temp_directory_path();
        temporary_ = std::make_unique<TemporaryFile>(
            directory, target_->kind == Target::Kind::Nothing ? 0666 : 0600);
    } catch (const std::system_error& e) {
        throw failure("cannot write '{}': {}", target.string(), e.code().message());
    }
}

FileInTheMaking::~FileInTheMaking() = default;

void FileInTheMaking::commit() {
    int error = 0;
    if (target_->isReplaced()) {
        if (target_->kind == Target::Kind::Regular)
            keepAttributes(temporary_->descriptor(), target_->file, target_->status);
        error = temporary_->rename(target_->file);
    }
    // A file that is a mount point cannot be replaced, nor a file of another user in a sticky
    // directory.
    const bool inPlace = error == EBUSY || error == EPERM;
    if (!target_->isReplaced() || inPlace) {
        const int to = target_->kind == Target::Kind::Descriptor ? ::dup(target_->descriptor)
                       : inPlace ? ::open(target_->file.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC)
                                 : openStream(target_->file);
        error = to < 0 ? errno : closeAfter(to, copyAll(temporary_->descriptor(), to));
    }
    if (error == ENXIO)
        throw failure("cannot write '{}': nothing reads from this pipe", named_.string());
    if (error) throw failure("cannot write '{}': {}", named_.string(), reasonOf(error));
    temporary_.reset();
}

void writeWholeFile(const fs::path& file, std::span<const unsigned char> bytes) {
    FileInTheMaking making(file);
    const int descriptor = making.temporary_->descriptor();
    // Some file systems report a full disk only when a descriptor is closed.
    if (const int error = closeAfter(::dup(descriptor), writeAll(descriptor, bytes)))
        throw failure("cannot write '{}': {}", file.string(), reasonOf(error));
    making.commit();
}

void writeWholeFile(const fs::path& file, std::string_view text) {
    writeWholeFile(file,
                   std::span(reinterpret_cast<const unsigned char*>(text.data()), text.size()));
}

void checkWritable(const fs::path& file) {
    using Kind = FileInTheMaking::Target::Kind;
    std::error_code ignored;
    if (fs::is_directory(file, ignored))
        throw usageError("cannot write '{}': it is a directory", file.string());
    const FileInTheMaking::Target target(file);
    if (target.kind == Kind::Other)
        throw usageError("cannot write '{}': it is a {}", file.string(),
                         S_ISBLK(target.status.st_mode) ? "block device" : "socket");
    if (target.kind == Kind::Descriptor) {
        const int flags = ::fcntl(target.descriptor, F_GETFL);
        if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY)
            throw usageError("cannot write '{}': descriptor {} is not open for writing",
                             file.string(), target.descriptor);
        return;
    }
    if (target.kind != Kind::Nothing &&
        ::faccessat(AT_FDCWD, target.file.c_str(), W_OK, AT_EACCESS) != 0)
        throw usageError("cannot write '{}': {}", file.string(),
                         errno == EACCES ? "it is write-protected" : reasonOf(errno));
    if (target.kind == Kind::Stream) return;
    const fs::path directory = directoryOf(target.file);
    if (!fs::exists(directory, ignored))
        throw usageError("cannot write '{}': there is no directory '{}'", file.string(),
                         directory.string());
    if (!fs::is_directory(directory, ignored))
        throw usageError("cannot write '{}': '{}' is not a directory", file.string(),
                         directory.string());
    // Permissions are not enough: root has them all, even where the file system takes no files.
    try {
        const TemporaryFile probe(directory, 0600);
    } catch (const std::system_error& e) {
        throw usageError("cannot write '{}': directory '{}': {}", file.string(), directory.string(),
                         e.code().message());
    }
    removeLeftovers(directory);
}

bool sameFile(const fs::path& a, const fs::path& b) {
    std::error_code missing;
    if (fs::equivalent(a, b, missing)) return true;
    // A name without a file may still lead to the same place as another name.
    return fs::weakly_canonical(a, missing) == fs::weakly_canonical(b, missing);
}

void refuseOverwriting(std::span<const fs::path> written, std::span<const fs::path> read) {
    std::error_code ignored;
    for (auto file = written.begin(); file != written.end(); ++file) {
        if (file->empty()) continue;
        const fs::file_status status = fs::status(*file, ignored);
        if (fs::exists(status) && !fs::is_regular_file(status)) continue;
        const auto isThis = [&](const fs::path& other) {
            return !other.empty() && sameFile(*file, other);
        };
        if (std::any_of(read.begin(), read.end(), isThis))
            throw usageError("'{}' is an input and an output", file->string());
        if (std::any_of(written.begin(), file, isThis))
            throw usageError("'{}' is named twice as an output", file->string());
    }
}

std::uint64_t bytesOfFile(const fs::path& file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return 0;
    const std::uintmax_t bytes = fs::file_size(file, error);
    return error ? 0 : bytes;
}

}  // namespace woodcock
