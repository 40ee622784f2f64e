// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/parse.h"

#include <gtest/gtest.h>

#include <limits>

#include "woodcock/base/error.h"

namespace woodcock::test {
namespace {

/// The message of the usage error that `parse(text)` throws; empty when it throws none.
template <class Parse>
std::string usageErrorOf(Parse parse, std::string_view text) {
    try {
        parse(text);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Usage);
        return error.what();
    }
    return {};
}

TEST(Parse, SampleRange) {
    EXPECT_EQ(parseSampleRange("0:16").first, 0);
    EXPECT_EQ(parseSampleRange("0:16").end, 16);
    EXPECT_EQ(parseSampleRange("128:129").first, 128);
    for (const char* wrong :
         {"", ":", "16", "4:4", "5:4", "-1:4", "1:2:3", "1: 2", "0:16x", ":3", "0:99999999999"})
        EXPECT_NE(usageErrorOf(parseSampleRange, wrong).find("expected FIRST:END"),
                  std::string::npos)
            << wrong;
    EXPECT_NE(usageErrorOf(parseSampleRange, "0:2147483648").find("END <= 2147483647"),
              std::string::npos);
}

TEST(Parse, TileNumber) {
    EXPECT_EQ(parseTileNumber("0/4").index, 0);
    EXPECT_EQ(parseTileNumber("3/4").count, 4);
    for (const char* wrong : {"", "/", "1", "4/4", "-1/4", "0/0", "1/2/3", "1/ 4", "1/4x"})
        EXPECT_NE(usageErrorOf(parseTileNumber, wrong)
                      .find("expected INDEX/COUNT, where INDEX "
                            "goes from 0 to COUNT - 1"),
                  std::string::npos)
            << wrong;
}

TEST(Parse, ImageSize) {
    EXPECT_EQ(parseImageSize("960x540").width, 960);
    EXPECT_EQ(parseImageSize("960x540").height, 540);
    EXPECT_EQ(parseImageSize("7").width, 7);
    EXPECT_EQ(parseImageSize("7").height, std::nullopt);
    for (const char* wrong :
         {"", "x", "0x540", "960x0", "0", "-3x4", "960x", "x540", "960*540", "70000", "1x2x3"})
        EXPECT_NE(usageErrorOf(parseImageSize, wrong).find("expected WIDTHxHEIGHT"),
                  std::string::npos)
            << wrong;
}

TEST(Parse, PixelRectangle) {
    const PixelRectangle r = parsePixelRectangle("1,2,30,40");
    EXPECT_EQ(r.x0, 1);
    EXPECT_EQ(r.y0, 2);
    EXPECT_EQ(r.x1, 30);
    EXPECT_EQ(r.y1, 40);
    for (const char* wrong :
         {"", "1,2,3", "1,2,3,4,5", "3,0,3,4", "0,4,3,4", "-1,0,3,4", "0,0,a,4", "0,0,3,"})
        EXPECT_NE(usageErrorOf(parsePixelRectangle, wrong).find("expected X0,Y0,X1,Y1"),
                  std::string::npos)
            << wrong;
}

TEST(Parse, Duration) {
    EXPECT_EQ(parseDuration("90"), 90);
    EXPECT_EQ(parseDuration("0.25s"), 0.25);
    EXPECT_EQ(parseDuration("1.5m"), 90);
    EXPECT_EQ(parseDuration("2h"), 7200);
    for (const char* wrong : {"", "s", "0", "-1s", "nan", "inf", "1d", "1 s", "1e999", "1m30s"})
        EXPECT_NE(usageErrorOf(parseDuration, wrong).find("is not a duration"), std::string::npos)
            << wrong;
}

TEST(Parse, Fraction) {
    EXPECT_DOUBLE_EQ(parseFraction("1%"), 0.01);
    EXPECT_DOUBLE_EQ(parseFraction("0.005"), 0.005);
    for (const char* wrong : {"", "%", "0", "0%", "-1%", "one", "1%%", "nan%"})
        EXPECT_NE(usageErrorOf(parseFraction, wrong).find("is not a fraction"), std::string::npos)
            << wrong;
}

TEST(Parse, Count) {
    EXPECT_EQ(parseCount("1", 1, 9), 1u);
    EXPECT_EQ(parseCount("18446744073709551615", 0, ~std::uint64_t{0}), ~std::uint64_t{0});
    for (const char* wrong : {"", "0", "10", "-1", "+1", "1.5", "1e0", "18446744073709551616"})
        EXPECT_EQ(usageErrorOf([](std::string_view text) { return parseCount(text, 1, 9); }, wrong),
                  "'" + std::string(wrong) + "' is not a whole number from 1 to 9");
}

TEST(Parse, Number) {
    EXPECT_EQ(parseNumber("-1.5", -2, 2000), -1.5);
    EXPECT_EQ(parseNumber("2e3", -2, 2000), 2000);
    const auto parse = [](std::string_view text) { return parseNumber(text, -2, 2000); };
    for (const char* wrong : {"", "x", "1x", "nan", "inf", "1e999", "1 "})
        EXPECT_EQ(usageErrorOf(parse, wrong),
                  "'" + std::string(wrong) + "' is not a number from -2 to 2000");
}

TEST(FormatDuration, RoundsWithinItsUnit) {
    EXPECT_EQ(formatDuration(0.254), "0.25 s");
    EXPECT_EQ(formatDuration(0.996), "1.0 s");
    EXPECT_EQ(formatDuration(59.94), "59.9 s");
    EXPECT_EQ(formatDuration(59.96), "1 m 00 s");
    EXPECT_EQ(formatDuration(245), "4 m 05 s");
    EXPECT_EQ(formatDuration(3599.6), "1 h 00 m");
    EXPECT_EQ(formatDuration(7620), "2 h 07 m");
    EXPECT_EQ(formatDuration(std::numeric_limits<double>::infinity()), "ages");
}

}  // namespace
}  // namespace woodcock::test
