// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/denormals_are_zero.h"

#include <gtest/gtest.h>

#include <cfloat>

namespace woodcock::test {

namespace {

// What the processor calculates, not the compiler.
volatile float smallest = FLT_MIN, denormal = FLT_MIN / 4;
float quarterOfSmallest() { return smallest * 0.25f; }
float fourDenormals() { return denormal * 4.0f; }

TEST(DenormalsAreZero, WhileItLives) {
#ifndef __SSE__
    GTEST_SKIP() << "this processor has no SSE";
#endif
    ASSERT_EQ(quarterOfSmallest(), FLT_MIN / 4);
    {
        const DenormalsAreZero flush;
        EXPECT_EQ(quarterOfSmallest(), 0);
        EXPECT_EQ(fourDenormals(), 0);
        {
            const DenormalsAreZero within;
            EXPECT_EQ(quarterOfSmallest(), 0);
        }
        EXPECT_EQ(quarterOfSmallest(), 0);
        EXPECT_EQ(smallest * 1.0f, FLT_MIN);
    }
    EXPECT_EQ(quarterOfSmallest(), FLT_MIN / 4);
    EXPECT_EQ(fourDenormals(), FLT_MIN);
}

}  // namespace

}  // namespace woodcock::test
