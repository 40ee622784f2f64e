// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/memory.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace woodcock::test {
namespace {

TEST(MemoryLimit, FollowsTheShells) {
    const std::uint64_t limit = memoryLimit();
    EXPECT_GT(limit, 64u << 20);  // this test runs in it
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
    rlimit half = before;
    half.rlim_cur = limit / 2;
    ASSERT_EQ(setrlimit(RLIMIT_AS, &half), 0);
    EXPECT_EQ(memoryLimit(), limit / 2);
    ASSERT_EQ(setrlimit(RLIMIT_AS, &before), 0);
    EXPECT_EQ(memoryLimit(), limit);
}

TEST(FormatGiB, KeepsTheDigitsThatMatter) {
    constexpr double gib = 1024.0 * 1024 * 1024;
    EXPECT_EQ(formatGiB(0.25 * gib), "0.25 GiB");
    EXPECT_EQ(formatGiB(23.44 * gib), "23.4 GiB");
    EXPECT_EQ(formatGiB(608.3 * gib), "608 GiB");
}

}  // namespace
}  // namespace woodcock::test
