// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/frame_range.h"

#include <OpenImageIO/filesystem.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/expect_error.h"

namespace woodcock::test {
namespace {

using Frames = std::vector<int>;

TEST(FrameRange, NamesFramesAsOpenImageIODoes) {
    for (const char* text : {"7", "1-5", "1-10x3", "1-10y3", "10-1", "10-1x3", "10-1y3",
                             "3,4,10-20x2", "5-5", "1-2x9", "1-48,60,100-120x2"}) {
        Frames theirs;
        ASSERT_TRUE(OIIO::Filesystem::enumerate_sequence(text, theirs)) << text;
        EXPECT_EQ(parseFrameRange(text), theirs) << text;
    }
    EXPECT_EQ(parseFrameRange("1-10x3"), (Frames{1, 4, 7, 10}));
    EXPECT_EQ(parseFrameRange("1-10y3"), (Frames{2, 3, 5, 6, 8, 9}));
    EXPECT_EQ(parseFrameRange("10-1x3"), (Frames{10, 7, 4, 1}));
    EXPECT_EQ(parseFrameRange("3,4,10-20x2"), (Frames{3, 4, 10, 12, 14, 16, 18, 20}));
}

TEST(FrameRange, HasNegativeFramesAndRefinement) {
    EXPECT_EQ(parseFrameRange("-3"), Frames{-3});
    EXPECT_EQ(parseFrameRange("-3-1"), (Frames{-3, -2, -1, 0, 1}));
    EXPECT_EQ(parseFrameRange("-1--3"), (Frames{-1, -2, -3}));
    EXPECT_EQ(parseFrameRange("-4--1x2,2"), (Frames{-4, -2, 2}));
    EXPECT_EQ(parseFrameRange("-10-100").size(), 111u);
    // As fileseq has it.
    EXPECT_EQ(parseFrameRange("1-10:3"), (Frames{1, 4, 7, 10, 3, 5, 9, 2, 6, 8}));
    EXPECT_EQ(parseFrameRange("1-3:99999999"), (Frames{1, 3, 2}));
}

TEST(FrameRange, TakesEachFrameOnce) {
    EXPECT_EQ(parseFrameRange("1-3,2-4,3"), (Frames{1, 2, 3, 4}));
}

TEST(FrameRange, RefusesWhatIsNoneAndSaysWhatIs) {
    const auto refuse = [](const char* text, const std::vector<std::string>& said) {
        for (const std::string& part : said)
            expectError(ErrorKind::Usage, part, [&] { parseFrameRange(text); });
    };
    for (const char* text : {"", ",", "1,", "a", "1-", "-", "--1", "1-2z3", "1-2x", "1 - 2", "1..5",
                             "1.5", "+1", "1-2x3x4", "0x10"})
        refuse(text, {"is no frame and no range", "1-48x2"});
    refuse("5-1x-1", {"'5-1x-1': the step is -1", "5-1 counts down by itself"});
    refuse("1-5x0", {"the step is 0"});
    refuse("1-10y1", {"leaves no frame"});
    refuse("1-2y1", {"leaves no frame"});
    refuse("7-7y2", {"leaves no frame"});
    refuse("0-99999999", {"these are 100000000 frames; at most 100000"});
    refuse("1-100000,200001", {"more than 100000 frames"});
    refuse("999999999", {"from -99999999 to 99999999"});
    refuse("99999999999999999999", {"from -99999999 to 99999999"});
}

TEST(FrameRange, IsSaidInTheShortestWay) {
    EXPECT_EQ(frameRangeText({3, 1, 2, 2}), "1-3");
    EXPECT_EQ(frameRangeText({1, 2, 4, 6, 7, 8, -1}), "-1,1-2,4,6-8");
    EXPECT_EQ(frameRangeText({}), "");
    const Frames some{-5, -4, -3, 0, 9, 10, 12};
    EXPECT_EQ(parseFrameRange(frameRangeText(some)), some);
}

}  // namespace
}  // namespace woodcock::test
