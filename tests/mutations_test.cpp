// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/paths.h"
#include "tests/support/run_program.h"

namespace woodcock::test {
namespace {

/// Code that moves must take its deliberate defects along.
TEST(Mutations, AllStillApply) {
    const ProgramResult result =
        runProgram({(sourceDir() / "tests/mutations/run.sh").string(), "--check"}, {}, "/bin/bash");
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_NE(result.out.find("defects"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace woodcock::test
