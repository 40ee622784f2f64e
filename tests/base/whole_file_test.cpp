// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/whole_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <iterator>

#include "tests/support/expect_error.h"
#include "tests/support/paths.h"
#include "woodcock/base/error.h"

namespace woodcock {
namespace {

namespace fs = std::filesystem;

/// A disk that fills up: no file of this process grows beyond `bytes` while it lives.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) : signal_(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, signal_);
    }

private:
    void (*signal_)(int);
    rlimit before_{};
};

auto filesIn(const fs::path& directory) {
    return std::distance(fs::directory_iterator(directory), fs::directory_iterator());
}

TEST(WholeFile, WritesAndReplaces) {
    const test::TempDir dir;
    const std::vector<unsigned char> bytes{'a', 0, 255};
    test::writeText(dir / "a.bin", "something longer that was there before");
    writeWholeFile(dir / "a.bin", bytes);
    EXPECT_EQ(test::readText(dir / "a.bin"), std::string(bytes.begin(), bytes.end()));
    EXPECT_EQ(filesIn(dir.path()), 1);
}

TEST(WholeFile, AFullDiskLeavesNothing) {
    const test::TempDir dir;
    // More than a buffer, so that writing fails; less than one, so that closing does.
    for (const size_t size : {1u << 20, 2000u}) {
        const std::vector<unsigned char> bytes(size, 7);
        const std::string message = test::messageOf(ErrorKind::Failure, [&] {
            const FileSizeLimit limit(1000);
            writeWholeFile(dir / "a.bin", bytes);
        });
        EXPECT_EQ(message,
                  fmt::format("cannot write '{}': File too large", (dir / "a.bin").string()));
        EXPECT_EQ(filesIn(dir.path()), 0);
    }
}

TEST(WholeFile, AFailureKeepsTheFormerFile) {
    const test::TempDir dir;
    test::writeText(dir / "a.bin", "former");
    EXPECT_THROW(
        {
            const FileSizeLimit limit(1000);
            writeWholeFile(dir / "a.bin", std::vector<unsigned char>(5000));
        },
        Error);
    EXPECT_EQ(test::readText(dir / "a.bin"), "former");
    EXPECT_EQ(filesIn(dir.path()), 1);
}

std::string check(const fs::path& file) {
    return test::messageOf(ErrorKind::Usage, [&] { checkWritable(file); });
}

TEST(WholeFile, ChecksThePlaceBeforehand) {
    const test::TempDir dir;
    test::writeText(dir / "file", "");
    EXPECT_EQ(check(dir / "a.exr"), "no error");
    EXPECT_EQ(filesIn(dir.path()), 1);
    EXPECT_NE(check(dir.path()).find("it is a directory"), std::string::npos);
    EXPECT_NE(check(dir / "none/a.exr").find("there is no directory"), std::string::npos);
    EXPECT_NE(check(dir / "file/a.exr").find("is not a directory"), std::string::npos);
}

TEST(WholeFile, ChecksPermissionBeforehand) {
    if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
    const test::TempDir dir;
    fs::permissions(dir.path(), fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_NE(check(dir / "a.exr").find("Permission denied"), std::string::npos);
    fs::permissions(dir.path(), fs::perms::owner_all);
}

}  // namespace
}  // namespace woodcock
