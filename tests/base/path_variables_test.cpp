// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/path_variables.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/expect_error.h"

namespace woodcock::test {
namespace {

TEST(PathVariables, AFramesNumberIsNone) {
    ASSERT_EQ(setenv("F4", "wrong", 1), 0);
    ASSERT_EQ(setenv("SHOT", "s1", 1), 0);
    EXPECT_EQ(expandPath("${SHOT}/a.$F4.vdb"), "s1/a.$F4.vdb");
    EXPECT_EQ(expandPath("a.$F.vdb"), "a.$F.vdb");
    EXPECT_EQ(expandPath("a.${F4}b.vdb"), "a.${F4}b.vdb");
    EXPECT_EQ(expandPath("a.$$F4.vdb"), "a.$F4.vdb");
    for (const char* path : {"a.$F4.vdb", "a.${F}.vdb", "$x.vdb"})
        EXPECT_EQ(expandPath(escapePath(path)), path);
    expectError(ErrorKind::Input, "FX is not set", [] { expandPath("a.$FX.vdb"); });
}

}  // namespace
}  // namespace woodcock::test
