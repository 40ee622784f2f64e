// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/whole_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <iterator>
#include <thread>

#include "tests/support/expect_error.h"
#include "tests/support/paths.h"
#include "woodcock/base/error.h"

namespace woodcock::test {

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
    const TempDir dir;
    const std::vector<unsigned char> bytes{'a', 0, 255};
    writeText(dir / "a.bin", "something longer that was there before");
    writeWholeFile(dir / "a.bin", bytes);
    EXPECT_EQ(readText(dir / "a.bin"), std::string(bytes.begin(), bytes.end()));
    EXPECT_EQ(filesIn(dir.path()), 1);
}

TEST(WholeFile, AFullDiskLeavesNothing) {
    const TempDir dir;
    // More than a buffer, so that writing fails; less than one, so that closing does.
    for (const size_t size : {1u << 20, 2000u}) {
        const std::vector<unsigned char> bytes(size, 7);
        const std::string message = messageOf(ErrorKind::Failure, [&] {
            const FileSizeLimit limit(1000);
            writeWholeFile(dir / "a.bin", bytes);
        });
        EXPECT_EQ(message,
                  fmt::format("cannot write '{}': File too large", (dir / "a.bin").string()));
        EXPECT_EQ(filesIn(dir.path()), 0);
    }
}

TEST(WholeFile, AFailureKeepsTheFormerFile) {
    const TempDir dir;
    writeText(dir / "a.bin", "former");
    EXPECT_THROW(
        {
            const FileSizeLimit limit(1000);
            writeWholeFile(dir / "a.bin", std::vector<unsigned char>(5000));
        },
        Error);
    EXPECT_EQ(readText(dir / "a.bin"), "former");
    EXPECT_EQ(filesIn(dir.path()), 1);
}

std::string check(const fs::path& file) {
    return messageOf(ErrorKind::Usage, [&] { checkWritable(file); });
}

TEST(WholeFile, ChecksThePlaceBeforehand) {
    const TempDir dir;
    writeText(dir / "file", "");
    EXPECT_EQ(check(dir / "a.exr"), "no error");
    EXPECT_EQ(filesIn(dir.path()), 1);
    EXPECT_NE(check(dir.path()).find("it is a directory"), std::string::npos);
    EXPECT_NE(check(dir / "none/a.exr").find("there is no directory"), std::string::npos);
    EXPECT_NE(check(dir / "file/a.exr").find("is not a directory"), std::string::npos);
}

TEST(WholeFile, ChecksPermissionBeforehand) {
    if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
    const TempDir dir;
    fs::permissions(dir.path(), fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_NE(check(dir / "a.exr").find("Permission denied"), std::string::npos);
    fs::permissions(dir.path(), fs::perms::owner_all);
}

struct stat statusOf(const fs::path& file) {
    struct stat status {};
    EXPECT_EQ(lstat(file.c_str(), &status), 0) << file;
    return status;
}

TEST(WholeFile, KeepsPermissionsAndOwner) {
    const TempDir dir;
    writeText(dir / "a", "former");
    fs::permissions(dir / "a", fs::perms(0660));
    if (geteuid() == 0) {
        ASSERT_EQ(chown((dir / "a").c_str(), 1234, 2345), 0);
    }
    const struct stat before = statusOf(dir / "a");
    writeWholeFile(dir / "a", "new");
    EXPECT_EQ(readText(dir / "a"), "new");
    EXPECT_EQ(statusOf(dir / "a").st_mode & 07777, 0660u);
    EXPECT_EQ(statusOf(dir / "a").st_uid, before.st_uid);
    EXPECT_EQ(statusOf(dir / "a").st_gid, before.st_gid);
}

TEST(WholeFile, NewFilesHaveTheUsersPermissions) {
    const TempDir dir;
    const mode_t before = umask(027);
    writeWholeFile(dir / "a", "new");
    umask(before);
    EXPECT_EQ(statusOf(dir / "a").st_mode & 07777, 0640u);
}

TEST(WholeFile, ASymbolicLinkStays) {
    const TempDir dir;
    fs::create_directory(dir / "far");
    writeText(dir / "far/target", "former");
    fs::create_symlink("far/target", dir / "near");
    fs::create_symlink("near", dir / "link");
    fs::create_symlink("far/new", dir / "dangling");
    for (const std::string name : {"link", "dangling"}) {
        checkWritable(dir / name);
        writeWholeFile(dir / name, name);
        EXPECT_TRUE(fs::is_symlink(dir / name));
    }
    EXPECT_TRUE(fs::is_symlink(dir / "near"));
    EXPECT_EQ(readText(dir / "far/target"), "link");
    EXPECT_EQ(readText(dir / "far/new"), "dangling");
    fs::create_symlink("circle", dir / "circle");
    EXPECT_NE(check(dir / "circle").find("symbolic links"), std::string::npos);
}

TEST(WholeFile, WritesIntoAPipe) {
    const TempDir dir;
    ASSERT_EQ(mkfifo((dir / "pipe").c_str(), 0600), 0);
    const std::string text(300000, 'x');  // more than a pipe holds
    std::string got;
    std::thread reader([&] { got = readText(dir / "pipe"); });
    checkWritable(dir / "pipe");
    writeWholeFile(dir / "pipe", text);
    reader.join();
    EXPECT_EQ(got, text);
    EXPECT_TRUE(fs::is_fifo(dir / "pipe"));
    EXPECT_EQ(filesIn(dir.path()), 1);
}

TEST(WholeFile, WritesIntoADevice) {
    const TempDir dir;
    const fs::path null = dir / "null", full = dir / "full";
    // Devices of this test's own: whoever replaces one must not get the system's.
    if (mknod(null.c_str(), S_IFCHR | 0666, makedev(1, 3)) != 0 ||
        mknod(full.c_str(), S_IFCHR | 0666, makedev(1, 7)) != 0)
        GTEST_SKIP() << "only root makes devices";
    const int opens = open(null.c_str(), O_WRONLY);
    if (opens < 0) GTEST_SKIP() << "devices do not work in the temporary directory";
    close(opens);
    for (const fs::path& device : {null, full}) checkWritable(device);
    writeWholeFile(null, "gone");
    FileInTheMaking making(null);
    writeText(making.temporary(), "gone as well");
    making.commit();
    EXPECT_EQ(messageOf(ErrorKind::Failure, [&] { writeWholeFile(full, "no room"); }),
              fmt::format("cannot write '{}': No space left on device", full.string()));
    EXPECT_TRUE(fs::is_character_file(null));
    EXPECT_TRUE(fs::is_character_file(full));
    EXPECT_EQ(filesIn(dir.path()), 2);
}

TEST(WholeFile, WritesIntoAnOpenDescriptor) {
    const TempDir dir;
    const int descriptor = open((dir / "log").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    ASSERT_EQ(write(descriptor, "head\n", 5), 5);
    const fs::path name = fmt::format("/dev/fd/{}", descriptor);
    checkWritable(name);
    writeWholeFile(name, "body");
    EXPECT_EQ(readText(dir / "log"), "head\nbody");
    struct stat open {};
    fstat(descriptor, &open);
    EXPECT_EQ(statusOf(dir / "log").st_ino, open.st_ino);
    close(descriptor);
    const int reads = ::open((dir / "log").c_str(), O_RDONLY | O_CLOEXEC);
    EXPECT_NE(check(fmt::format("/dev/fd/{}", reads)).find("is not open for writing"),
              std::string::npos);
    close(reads);
}

TEST(WholeFile, AWriteProtectedFileIsNoPlaceToWrite) {
    if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
    const TempDir dir;
    writeText(dir / "a", "former");
    fs::permissions(dir / "a", fs::perms(0444));
    EXPECT_NE(check(dir / "a").find("it is write-protected"), std::string::npos);
}

TEST(WholeFile, ClearsUpAfterKilledRunsAlone) {
    const TempDir dir;
    const pid_t killed = fork();
    if (killed == 0) {
        const TemporaryFile left(dir.path(), 0600);
        _exit(write(left.descriptor(), "half", 4) == 4 ? 0 : 1);  // without its destructor
    }
    int status = 1;
    waitpid(killed, &status, 0);
    ASSERT_EQ(status, 0);
    ASSERT_EQ(filesIn(dir.path()), 1);
    const fs::path left = fs::directory_iterator(dir.path())->path();

    const TemporaryFile living(dir.path(), 0600);
    for (const char* others : {".woodcock-0123456789abcdef.part", ".a.exr.0123abcd.part", "b.part"})
        writeText(dir / others, "somebody else's");
    // As a link it would lead the clearing elsewhere.
    const std::string name = left.filename().string();
    fs::create_symlink("b.part",
                       dir / (name.substr(0, name.size() - 21) + "0123456789abcdef.part"));
    checkWritable(dir / "new.exr");
    EXPECT_FALSE(fs::exists(left));
    EXPECT_TRUE(fs::exists(living.path()));
    EXPECT_EQ(filesIn(dir.path()), 5);
}

TEST(WholeFile, NothingThatIsReadIsWrittenOver) {
    const TempDir dir;
    writeText(dir / "in.vdb", "in");
    fs::create_symlink("in.vdb", dir / "link.vdb");
    fs::create_hard_link(dir / "in.vdb", dir / "hard.vdb");
    const auto said = [&](std::vector<fs::path> written) {
        return messageOf(ErrorKind::Usage, [&] {
            refuseOverwriting(written, std::array{fs::path(), dir / "in.vdb"});
        });
    };
    for (const char* name : {"in.vdb", "link.vdb", "hard.vdb"})
        EXPECT_EQ(said({dir / name}),
                  fmt::format("'{}' is an input and an output", (dir / name).string()));
    EXPECT_EQ(said({dir / "new.vdb", {}, {}, "/dev/null", "/dev/null"}), "no error");
    const fs::path same = dir.path() / "." / "new.vdb";
    EXPECT_EQ(said({dir / "new.vdb", same}),
              fmt::format("'{}' is named twice as an output", same.string()));
}

}  // namespace
}  // namespace woodcock::test
