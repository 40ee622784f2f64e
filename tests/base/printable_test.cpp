// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/printable.h"

#include <gtest/gtest.h>

namespace woodcock::test {
namespace {

TEST(Printable, ControlCharactersAreSpelledOut) {
    EXPECT_EQ(printable("den\nsity"), "den\\x0asity");
    EXPECT_EQ(printable(std::string_view("\x1b[2J\0\x7f", 6)), "\\x1b[2J\\x00\\x7f");
}

TEST(Printable, LettersOfAnyLanguageStay) {
    EXPECT_EQ(printable("Dichte 密度 ü[2]"), "Dichte 密度 ü[2]");
}

}  // namespace
}  // namespace woodcock::test
