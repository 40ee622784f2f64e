// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/frame_names.h"

#include <gtest/gtest.h>

#include "tests/support/paths.h"

namespace woodcock::test {

namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;
using Names = std::vector<std::string>;

TEST(FrameNames, PatternsOfManyPrograms) {
    const std::vector<std::pair<const char*, const char*>> patterns{
        {"smoke.####.vdb", "####"},
        {"smoke.#.vdb", "#"},
        {"shots/a_#_b.exr", "#"},
        {"smoke.@@@.vdb", "@@@"},
        {"smoke_%04d.vdb", "%04d"},
        {"smoke.%d.png", "%d"},
        {"smoke.$F4.vdb", "$F4"},
        {"smoke.$F.vdb", "$F"},
        {"smoke.${F4}.vdb", "${F4}"},
        {"smoke.${FRAME}.png", "${FRAME}"},
        {"smoke.<frame04>.vdb", "<frame04>"},
        {"smoke.<f>.vdb", "<f>"},
        {"smoke.{frame:04d}.vdb", "{frame:04d}"},
        {"smoke.{0009..0011}.vdb", "{0009..0011}"},
        {"smoke.*.vdb", "*"}};
    for (const auto& [name, pattern] : patterns) EXPECT_EQ(framePattern(name), pattern) << name;
}

TEST(FrameNames, OrdinaryNamesHoldNoPattern) {
    for (const char* name : {"smoke.vdb", "smoke.0001.vdb", "c#.png", "take#2.exr", "me@home.png",
                             "50%done.png", "100%.png", "$HOME/a.png", "a.$FOO.png",
                             "${SHOT}/a.png", "<tag>.png", "{a}.png", "a-b_c (1).png", ""})
        EXPECT_EQ(framePattern(name), "") << name;
}

TEST(FrameNames, FilesThatDifferInNumbersAloneAreFrames) {
    EXPECT_EQ(framesAmong(Paths{"a.0009.vdb", "a.0010.vdb", "a.0011.vdb"}).size(), 3u);
    EXPECT_EQ(framesAmong(Paths{"a9.vdb", "./a10.vdb"}).size(), 2u);
    EXPECT_EQ(framesAmong(Paths{"f_0001/smoke.vdb", "f_0002/smoke.vdb"}).size(), 2u);
    EXPECT_EQ(framesAmong(Paths{"smoke.-001.vdb", "smoke.0000.vdb"}).size(), 2u);
    EXPECT_EQ(framesAmong(Paths{"tile_0_1.vdb", "tile_1_0.vdb"}).size(), 2u);
    // Beside something else, too.
    EXPECT_EQ(framesAmong(Paths{"ground.vdb", "a.1.vdb", "fire.1.vdb", "a.2.vdb"}),
              (Paths{"a.1.vdb", "a.2.vdb"}));
}

TEST(FrameNames, OtherFilesAreNone) {
    EXPECT_TRUE(framesAmong(Paths{}).empty());
    EXPECT_TRUE(framesAmong(Paths{"a.1.vdb"}).empty());
    EXPECT_TRUE(framesAmong(Paths{"density.vdb", "fire.vdb"}).empty());
    EXPECT_TRUE(framesAmong(Paths{"density.0009.vdb", "fire.0009.vdb"}).empty());
    EXPECT_TRUE(framesAmong(Paths{"a.1.vdb", "a.1.vdb"}).empty());  // the same one twice
    EXPECT_TRUE(framesAmong(Paths{"a.1.vdb", "./a.1.vdb"}).empty());
    EXPECT_TRUE(framesAmong(Paths{"a.vdb", "a1.vdb"}).empty());
    EXPECT_TRUE(framesAmong(Paths{"a-1.vdb", "a_1.vdb"}).empty());
}

TEST(FrameNames, ASeriesIsWhatStandsAroundTheNumber) {
    const auto series = seriesOf(Paths{"v2/a.0010.vdb", "v2/a.0009.vdb", "v2/a.0011.vdb"});
    ASSERT_TRUE(series);
    EXPECT_EQ(series->before, "v2/a.");
    EXPECT_EQ(series->after, ".vdb");
    EXPECT_EQ(series->numbers, (Names{"0009", "0010", "0011"}));
    EXPECT_EQ(series->name("7"), "v2/a.7.vdb");
    EXPECT_EQ(seriesOf(Paths{"a10.vdb", "a9.vdb"}).value().numbers, (Names{"9", "10"}));
    EXPECT_EQ(seriesOf(Paths{"a.-001.vdb", "a.0000.vdb"}).value().numbers, (Names{"-001", "0000"}));
    EXPECT_FALSE(seriesOf(Paths{"tile_0_1.vdb", "tile_1_0.vdb"}));
    EXPECT_FALSE(seriesOf(Paths{"a1.vdb"}));
}

TEST(FrameNames, APatternFindsItsFiles) {
    const TempDir dir;
    for (const char* name :
         {"a.0010.vdb", "a.0002.vdb", "a.x.vdb", "a..vdb", "b.0003.vdb", "a.0004.png", "a.-01.vdb"})
        writeText(dir / name, "");
    for (const char* pattern : {"a.####.vdb", "a.%04d.vdb", "a.$F4.vdb", "a.*.vdb"})
        EXPECT_EQ(seriesOfPattern((dir / pattern).string()).numbers, (Names{"-01", "0002", "0010"}))
            << pattern;
    EXPECT_TRUE(seriesOfPattern((dir / "c.####.vdb").string()).numbers.empty());
    EXPECT_TRUE(seriesOfPattern((dir / "none/a.####.vdb").string()).numbers.empty());
    EXPECT_TRUE(seriesOfPattern((dir / "f####/a.vdb").string()).numbers.empty());
}

TEST(FrameNames, FilesAroundOneDifferInItsLastNumber) {
    const TempDir dir;
    for (const char* name : {"v2.0009.vdb", "v2.0010.vdb", "v3.0009.vdb", "v2.0009.png", "a.vdb"})
        writeText(dir / name, "");
    EXPECT_EQ(seriesAround(dir / "v2.0009.vdb").numbers, (Names{"0009", "0010"}));
    EXPECT_EQ(seriesAround(dir / "v2.0010.vdb").name("0009"), (dir / "v2.0009.vdb").string());
    EXPECT_EQ(seriesAround(dir / "v3.0009.vdb").numbers, Names{"0009"});
    EXPECT_TRUE(seriesAround(dir / "a.vdb").numbers.empty());
}

TEST(FrameNames, NumbersAreWrittenAsShellsTakeThem) {
    EXPECT_EQ(shellNumbers({"0009", "0010"}), "0009 0010");
    EXPECT_EQ(shellNumbers({"08", "09", "10", "11", "12", "13", "14"}), "{08..14}");
    EXPECT_EQ(shellNumbers({"8", "9", "10", "11", "12", "13", "14"}), "{8..14}");
    EXPECT_EQ(shellNumbers({"1", "2", "3", "4", "5", "6", "8"}), "1 2 3 4 5 6 8");
    EXPECT_EQ(shellNumbers({"-1", "0", "1", "2", "3", "4", "5"}), "-1 0 1 2 3 4 5");
}

}  // namespace
}  // namespace woodcock::test
