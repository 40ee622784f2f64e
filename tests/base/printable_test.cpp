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

TEST(Printable, WhatOnlyLooksLikeLettersIsSpelledOut) {
    EXPECT_EQ(printable("a\xc2\x9b[31m"), "a\\xc2\\x9b[31m");             // CSI of C1
    EXPECT_EQ(printable("exe\xe2\x80\xaegpj"), "exe\\xe2\\x80\\xaegpj");  // right to left
    EXPECT_EQ(printable("a\xff\xc3"), "a\\xff\\xc3");                     // no UTF-8
    EXPECT_EQ(printable("\xc1\x81"), "\\xc1\\x81");                       // overlong
    EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");              // a surrogate
}

TEST(Printable, LinesKeepTheirEnds) {
    EXPECT_EQ(printableLines("a\n\tb\x1b\r"), "a\n\tb\\x1b\\x0d");
}

TEST(Printable, LongTextsAreCutBetweenLetters) {
    EXPECT_EQ(shown("short"), "short");
    EXPECT_EQ(shown(std::string(1 << 20, 'x')), std::string(200, 'x') + "...");
    EXPECT_EQ(shown("aüb", 2), "a...");
}

}  // namespace
}  // namespace woodcock::test
