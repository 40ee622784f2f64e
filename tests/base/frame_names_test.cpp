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

TEST(FrameNames, PatternsAreFilledIn) {
    const auto in7 = [](const char* name) { return withFrame(name, 7); };
    EXPECT_EQ(in7("s.####.vdb"), "s.0007.vdb");
    EXPECT_EQ(in7("s.#.vdb"), "s.7.vdb");
    EXPECT_EQ(in7("s.@@@.vdb"), "s.007.vdb");
    EXPECT_EQ(in7("s.%04d.vdb"), "s.0007.vdb");
    EXPECT_EQ(in7("s.%d.vdb"), "s.7.vdb");
    EXPECT_EQ(in7("s%012d"), "s000000000007");
    EXPECT_EQ(in7("s.$F.vdb"), "s.7.vdb");
    EXPECT_EQ(in7("s.$F4.vdb"), "s.0007.vdb");
    EXPECT_EQ(in7("s.${F4}x.vdb"), "s.0007x.vdb");
    EXPECT_EQ(in7("s.<frame04>.vdb"), "s.0007.vdb");
    EXPECT_EQ(in7("s.<f>.vdb"), "s.7.vdb");
    EXPECT_EQ(in7("f_####/s.####.vdb"), "f_0007/s.0007.vdb");
    // More digits than places are written whole, and a minus takes one.
    EXPECT_EQ(withFrame("s.##.vdb", 12345), "s.12345.vdb");
    EXPECT_EQ(withFrame("s.%04d.vdb", -5), "s.-005.vdb");
    EXPECT_EQ(withFrame("s.####.vdb", -5), "s.-005.vdb");
    for (const char* name :
         {"smoke.vdb", "c#.png", "take#2.exr", "me@home.png", "50%done.png", "a.$FOO.png",
          "s.{frame:04d}.vdb", "s.${FRAME}.vdb", "s.*.vdb", "s.%4d.vdb", "s.%s.vdb", ""}) {
        EXPECT_EQ(in7(name), name);
        EXPECT_FALSE(namesFrame(name)) << name;
    }
    EXPECT_TRUE(namesFrame("s.$F4.vdb"));
    EXPECT_EQ(withFrame(std::string(100000, '#'), 1).size(), 100000u);
}

TEST(FrameNames, WhatIsOnDiskIsWhatIsFilledIn) {
    const TempDir dir;
    for (const char* name : {"a.0010.vdb", "a.0002.vdb", "a.-003.vdb", "a.11.vdb", "a.x.vdb",
                             "a.12345.vdb", "f_2/s.2.vdb", "f_3/s.2.vdb", "f_4/s.4.vdb"}) {
        std::filesystem::create_directories((dir / name).parent_path());
        writeText(dir / name, "");
    }
    const auto frames = [&](const char* name) { return framesOnDisk((dir / name).string()); };
    for (const char* name : {"a.####.vdb", "a.%04d.vdb", "a.$F4.vdb", "a.<frame04>.vdb"})
        EXPECT_EQ(frames(name), (std::vector{-3, 2, 10, 12345})) << name;
    EXPECT_EQ(frames("a.$F.vdb"), (std::vector{11, 12345}));  // padded numbers have other names
    EXPECT_EQ(frames("f_#/s.#.vdb"), (std::vector{2, 4}));
    EXPECT_TRUE(frames("a.0010.vdb").empty());
    EXPECT_TRUE(frames("none/a.####.vdb").empty());
}

TEST(FrameNames, ASeriesHasAPattern) {
    const auto pattern = [](const Paths& files) {
        return patternOf(seriesOf(files).value()).value_or("none");
    };
    EXPECT_EQ(pattern({"a.0009.vdb", "a.0010.vdb"}), "a.####.vdb");
    EXPECT_EQ(pattern({"a.9.vdb", "a.10.vdb"}), "a.#.vdb");
    EXPECT_EQ(pattern({"a9.vdb", "a10.vdb"}), "a%d.vdb");
    EXPECT_EQ(pattern({"a.9.vdb", "a.0010.vdb"}), "none");
}

}  // namespace
}  // namespace woodcock::test
