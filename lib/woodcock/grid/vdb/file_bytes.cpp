// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb/file_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "woodcock/base/frame_names.h"

namespace woodcock::grid {

namespace {

constexpr std::uint64_t usualWindow = 1 << 16;

std::uint64_t sizeOfRegularFile(const std::filesystem::path& file, std::string_view expected) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) {
        if (errno == ENOENT || errno == ENOTDIR) {
            const std::string pattern = framePattern(file.string());
            throw inputError("{} does not exist{}", file.string(),
                             pattern.empty() ? ""
                                             : fmt::format("; '{}' stands for a frame's "
                                                           "number: name one frame's file, or "
                                                           "give --frames where a command has it",
                                                           pattern));
        }
        throw inputError("cannot open {}: {}", file.string(), std::strerror(errno));
    }
    if (S_ISDIR(status.st_mode))
        throw inputError("{} is a directory; expected {}", file.string(), expected);
    if (!S_ISREG(status.st_mode))
        throw inputError("{} is not a regular file; expected {}", file.string(), expected);
    return static_cast<std::uint64_t>(status.st_size);
}

}  // namespace

FileBytes::FileBytes(const std::filesystem::path& file, std::string_view expected)
    : path_(file), size_(sizeOfRegularFile(file, expected)), end_(size_) {
    descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor_ < 0)
        throw inputError("cannot open {}: {}", file.string(), std::strerror(errno));
}

FileBytes::~FileBytes() { ::close(descriptor_); }

void FileBytes::enter(std::uint64_t begin, std::uint64_t end, std::string place) {
    place_ = std::move(place);
    if (begin > end || end > size_) throw damaged(fmt::format("bytes {} to {}", begin, end));
    position_ = begin;
    end_ = end;
}

void FileBytes::loadAll() {
    if (left() > 0) refill(left());
}

std::string FileBytes::text() {
    const auto length = value<std::uint32_t>();
    const std::span<const char> characters = bytes(length);
    return {characters.begin(), characters.end()};
}

void FileBytes::seek(std::uint64_t position) {
    if (position > end_) throw reachesBeyond(position - std::min(position_, position));
    position_ = position;
}

std::span<const char> FileBytes::loaded(std::uint64_t begin, std::uint64_t end) const {
    return {window_.get() + (begin - windowBegin_), static_cast<std::size_t>(end - begin)};
}

Error FileBytes::damaged(const std::string& what) const {
    return inputError("{} is cut short or damaged: {}: {} at byte {}{}", path_.string(), place_,
                      what, position_, wayOut());
}

std::string FileBytes::wayOut() const {
    if (doubt_.empty()) return {};
    return fmt::format("; {}: save it with a program that uses OpenVDB 13 or an older one", doubt_);
}

Error FileBytes::reachesBeyond(std::uint64_t n) const {
    return damaged(fmt::format("{} bytes where {} are left", n, left()));
}

void FileBytes::refill(std::uint64_t n) {
    n = std::min(std::max(n, usualWindow), left());
    windowBytes_ = 0;
    window_ = std::make_unique_for_overwrite<char[]>(n);
    windowBegin_ = position_;
    for (std::uint64_t got = 0; got < n;) {
        const ssize_t more =
            ::pread(descriptor_, window_.get() + got, n - got, static_cast<off_t>(position_ + got));
        if (more < 0 && errno == EINTR) continue;
        if (more < 0) throw inputError("cannot read {}: {}", path_.string(), std::strerror(errno));
        if (more == 0)
            throw inputError("{} shrank while it was read: byte {} is gone", path_.string(),
                             position_ + got);
        got += static_cast<std::uint64_t>(more);
    }
    windowBytes_ = n;
}

MemoryBuffer::MemoryBuffer(std::span<const char> bytes) {
    char* const begin = const_cast<char*>(bytes.data());  // only ever read
    setg(begin, begin, begin + bytes.size());
}

MemoryBuffer::pos_type MemoryBuffer::seekoff(off_type offset, std::ios_base::seekdir from,
                                             std::ios_base::openmode) {
    const off_type size = egptr() - eback();
    const off_type base = from == std::ios_base::beg   ? 0
                          : from == std::ios_base::cur ? gptr() - eback()
                                                       : size;
    if (offset < -base || offset > size - base) return pos_type(off_type(-1));
    setg(eback(), eback() + base + offset, egptr());
    return pos_type(base + offset);
}

MemoryBuffer::pos_type MemoryBuffer::seekpos(pos_type position, std::ios_base::openmode mode) {
    return seekoff(off_type(position), std::ios_base::beg, mode);
}

}  // namespace woodcock::grid
