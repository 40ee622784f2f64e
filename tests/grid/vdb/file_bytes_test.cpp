// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb/file_bytes.h"

#include <gtest/gtest.h>

#include <istream>

#include "tests/support/expect_error.h"
#include "tests/support/paths.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace grid;
using namespace proof;

namespace {

class FileBytesTest : public ::testing::Test {
protected:
    FileBytesTest() {
        text_.resize(200'000);
        for (std::size_t i = 0; i < text_.size(); ++i) text_[i] = static_cast<char>(i * i / 7);
        writeText(file_, text_);
    }
    TempDir dir_;
    std::filesystem::path file_ = dir_ / "bytes.vdb";
    std::string text_;
};

TEST_F(FileBytesTest, AnyPlaceInAnyOrder) {
    FileBytes file(file_);
    EXPECT_EQ(file.size(), text_.size());
    for (const std::size_t at : {150'000, 3, 65'530, 199'990, 0}) {
        file.seek(at);
        const std::span<const char> bytes = file.bytes(10);
        EXPECT_EQ(std::string(bytes.begin(), bytes.end()), text_.substr(at, 10));
        EXPECT_EQ(file.position(), at + 10);
    }
    file.enter(100, 150'000, "a part");
    file.loadAll();
    const std::span<const char> all = file.loaded(200, 149'000);
    EXPECT_EQ(std::string(all.begin(), all.end()), text_.substr(200, 148'800));
}

TEST_F(FileBytesTest, NothingReachesBeyondTheLimits) {
    FileBytes file(file_);
    file.enter(1000, 1010, "grid 'a'");
    file.skip(4);
    const std::string place = file_.string() + " is cut short or damaged: grid 'a': ";
    expectError(ErrorKind::Input, place + "7 bytes where 6 are left at byte 1004",
                [&] { file.bytes(7); });
    expectError(ErrorKind::Input, place, [&] { file.skip(~std::uint64_t(0)); });
    expectError(ErrorKind::Input, place, [&] { file.seek(1011); });
    expectError(ErrorKind::Input, "bytes 5 to 200001",
                [&] { file.enter(5, text_.size() + 1, "grid 'b'"); });
    EXPECT_EQ(file.bytes(6).size(), 6u);
}

TEST_F(FileBytesTest, AFileThatShrinksIsAnError) {
    FileBytes file(file_);
    file.bytes(10);
    truncateFile(file_, 100'000);
    expectError(ErrorKind::Input, file_.string() + " shrank while it was read: byte 100000 is gone",
                [&] {
                    file.seek(90'000);
                    file.bytes(20'000);
                });
}

TEST(MemoryBuffer, ReadsAndSeeksInBounds) {
    MemoryBuffer buffer(std::string_view("0123456789"));
    std::istream stream(&buffer);
    stream.seekg(4);
    EXPECT_EQ(stream.get(), '4');
    stream.seekg(2, std::ios::cur);
    EXPECT_EQ(stream.tellg(), 7);
    EXPECT_EQ(stream.get(), '7');
    stream.seekg(0, std::ios::end);
    EXPECT_EQ(stream.tellg(), 10);
    EXPECT_EQ(stream.get(), EOF);
    for (const int beyond : {-1, 11}) {
        stream.clear();
        stream.seekg(beyond);
        EXPECT_TRUE(stream.fail()) << beyond;
    }
}

}  // namespace
}  // namespace woodcock::test
