// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <span>
#include <streambuf>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "woodcock/base/error.h"

namespace woodcock::grid {

/// Reads a file piece by piece, from any position, and never beyond its end. The bytes are copied:
/// if the file shrinks meanwhile, that is an error, where a mapped file would end the program.
class FileBytes {
public:
    /// Errors: Input when the file is missing, not a regular file, or cannot be opened; the message
    /// says what was `expected`.
    explicit FileBytes(const std::filesystem::path& file,
                       std::string_view expected = "a .vdb file");
    ~FileBytes();
    FileBytes(const FileBytes&) = delete;
    FileBytes& operator=(const FileBytes&) = delete;

    std::uint64_t size() const { return size_; }
    std::uint64_t position() const { return position_; }
    std::uint64_t left() const { return end_ - position_; }

    /// Limits reading to bytes [begin, end) of the file, and goes to `begin`. Errors: Input.
    void enter(std::uint64_t begin, std::uint64_t end, std::string place);
    /// Reads the rest of the bytes within the limits into memory at once.
    void loadAll();

    /// The next `n` bytes, valid until the next call of a function of this class.
    std::span<const char> bytes(std::uint64_t n) {
        require(n);
        if (position_ < windowBegin_ || position_ + n > windowBegin_ + windowBytes_) refill(n);
        const char* const begin = window_.get() + (position_ - windowBegin_);
        position_ += n;
        return {begin, static_cast<std::size_t>(n)};
    }
    template <class T>
    T value() {
        static_assert(std::is_trivially_copyable_v<T>);
        T v;
        std::memcpy(&v, bytes(sizeof v).data(), sizeof v);
        return v;
    }
    std::string text();  ///< a 32-bit length and as many characters
    void skip(std::uint64_t n) {
        require(n);
        position_ += n;
    }
    void seek(std::uint64_t position);

    /// All bytes of [begin, end), which must be in memory after loadAll().
    std::span<const char> loaded(std::uint64_t begin, std::uint64_t end) const;

    /// Why a sound file may still not be understood; empty where its kind is known.
    void setDoubt(std::string doubt) { doubt_ = std::move(doubt); }
    const std::string& doubt() const { return doubt_; }
    /// The end of an error message about that: "; <doubt>: save it ...", or empty.
    std::string wayOut() const;

    /// "<file> is cut short or damaged: <place>: <what> at byte <position>", and wayOut()
    Error damaged(const std::string& what) const;
    const std::filesystem::path& path() const { return path_; }

private:
    void require(std::uint64_t n) const {
        if (n > left()) throw reachesBeyond(n);
    }
    Error reachesBeyond(std::uint64_t n) const;
    void refill(std::uint64_t n);

    std::filesystem::path path_;
    std::string place_ = "its header", doubt_;
    int descriptor_ = -1;
    std::uint64_t size_ = 0, position_ = 0, end_ = 0;
    std::unique_ptr<char[]> window_;  // bytes of the file from windowBegin_ on
    std::uint64_t windowBegin_ = 0, windowBytes_ = 0;
};

/// Bytes in memory as the source of a std::istream. Reads that reach beyond fail.
class MemoryBuffer : public std::streambuf {
public:
    explicit MemoryBuffer(std::span<const char> bytes);

protected:
    pos_type seekoff(off_type offset, std::ios_base::seekdir from,
                     std::ios_base::openmode) override;
    pos_type seekpos(pos_type position, std::ios_base::openmode mode) override;
};

}  // namespace woodcock::grid
