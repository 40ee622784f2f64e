// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/regular_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/expect_error.h"
#include "tests/support/paths.h"

namespace woodcock::test {

namespace {

std::string opening(const std::filesystem::path& file) {
    return messageOf(ErrorKind::Input, [&] { RegularFile(file, "table"); });
}

TEST(RegularFile, OthersAreRefusedAtOnce) {
    const TempDir dir;
    ASSERT_EQ(mkfifo((dir / "pipe").c_str(), 0600), 0);
    std::filesystem::create_symlink("/dev/zero", dir / "zero");
    const auto expected = [&](const char* name, const char* reason) {
        return fmt::format("cannot read table '{}': {}", (dir / name).string(), reason);
    };
    EXPECT_EQ(opening(dir / "pipe"), expected("pipe", "it is a pipe; expected a regular file"));
    EXPECT_EQ(opening(dir / "zero"), expected("zero", "it is a device; expected a regular file"));
    EXPECT_EQ(opening(dir / "none"), expected("none", "there is no such file"));
    EXPECT_EQ(opening(dir.path()),
              fmt::format("cannot read table '{}': it is a directory", dir.path().string()));
}

TEST(RegularFile, ReadsWhatIsThere) {
    const TempDir dir;
    writeText(dir / "a", "0123456789");
    const RegularFile file(dir / "a", "table");
    EXPECT_EQ(file.size(), 10u);
    EXPECT_EQ(file.read(2, 3), "234");
    EXPECT_EQ(file.read(8, 100), "89");
    EXPECT_EQ(file.read(10, 1), "");
    EXPECT_EQ(file.read(~std::uint64_t{0}, 1), "");
    EXPECT_EQ(readRegularFile(dir / "a", "table", 10), "0123456789");
    expectError(ErrorKind::Input, "it has 10 bytes; such a file may have 9 at most",
                [&] { readRegularFile(dir / "a", "table", 9); });
}

}  // namespace
}  // namespace woodcock::test
