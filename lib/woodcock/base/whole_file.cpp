// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/whole_file.h"

#include <cerrno>
#include <cstdio>
#include <random>
#include <system_error>

#include "woodcock/base/error.h"

namespace woodcock {

namespace fs = std::filesystem;

namespace {

fs::path directoryOf(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

fs::path temporaryBeside(const fs::path& file) {
    return directoryOf(file) /
           fmt::format(".{}.{:08x}.part", file.filename().string(), std::random_device{}());
}

/// Zero, or the errno of the first step that failed.
int writeBytes(const fs::path& file, std::span<const unsigned char> bytes) {
    std::FILE* out = std::fopen(file.c_str(), "wbx");
    if (!out) return errno;
    const bool written =
        bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), out) == bytes.size();
    const int error = written ? 0 : errno;
    // A full disk may show itself only when the buffers are flushed.
    const int closeError = std::fclose(out) == 0 ? 0 : errno;
    return error ? error : closeError;
}

}  // namespace

FileInTheMaking::FileInTheMaking(const fs::path& target)
    : target_(target), temporary_(temporaryBeside(target)) {}

FileInTheMaking::~FileInTheMaking() {
    std::error_code ignored;
    if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

void FileInTheMaking::commit() {
    std::error_code error;
    fs::rename(temporary_, target_, error);
    if (error) throw failure("cannot write '{}': {}", target_.string(), error.message());
    temporary_.clear();
}

void writeWholeFile(const fs::path& file, std::span<const unsigned char> bytes) {
    FileInTheMaking making(file);
    if (const int error = writeBytes(making.temporary(), bytes))
        throw failure("cannot write '{}': {}", file.string(),
                      std::generic_category().message(error));
    making.commit();
}

void checkWritable(const fs::path& file) {
    std::error_code ignored;
    const fs::path directory = directoryOf(file);
    if (fs::is_directory(file, ignored))
        throw usageError("cannot write '{}': it is a directory", file.string());
    if (!fs::exists(directory, ignored))
        throw usageError("cannot write '{}': there is no directory '{}'", file.string(),
                         directory.string());
    if (!fs::is_directory(directory, ignored))
        throw usageError("cannot write '{}': '{}' is not a directory", file.string(),
                         directory.string());
    // Permissions alone do not tell: root has them all, even where the file system takes no files.
    const fs::path temporary = temporaryBeside(file);
    const int error = writeBytes(temporary, {});
    fs::remove(temporary, ignored);
    if (error)
        throw usageError("cannot write '{}': directory '{}': {}", file.string(), directory.string(),
                         std::generic_category().message(error));
}

}  // namespace woodcock
