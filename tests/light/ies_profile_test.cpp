// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/ies_profile.h"

#include <gtest/gtest.h>

#include "woodcock/error.h"
#include "woodcock/light/point_light.h"

namespace woodcock::test {

using namespace light;

namespace {

/// 1 lamp; 3 vertical and 2 horizontal angles, 0 to 90: a quarter.
std::string quarter() {
    return "IESNA91\n[MANUFAC] none\nTILT=NONE\n1 1000 1 3 2 1 2 0.1 0.1 0\n1 1 60\n0 45 90\n0 90\n"
           "100 80 60\n100 40 20\n";
}
std::string with(std::string text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    return text.replace(at, from.size(), to);
}
std::string mistake(const std::string& text) {
    try {
        IesProfile::read(text, "lamp.ies");
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Input);
        return e.what();
    }
    return "no error";
}

Vec3d towards(double vertical, double horizontal) {
    const double v = vertical * pi / 180, h = horizontal * pi / 180;
    return {-std::sin(v) * std::sin(h), -std::sin(v) * std::cos(h), -std::cos(v)};
}
double candela(const IesProfile& p, double v, double h) {
    return p.value(towards(v, h)) / IesProfile::fromCandela;
}

TEST(IesProfile, MirrorsAQuarterAllAround) {
    const IesProfile p = IesProfile::read(quarter(), "lamp.ies");
    EXPECT_NEAR(candela(p, 0, 0), 100, 1e-9);
    EXPECT_NEAR(candela(p, 45, 0), 80, 1e-9);
    for (const double h : {20.0, 160.0, 200.0, 340.0})
        EXPECT_NEAR(candela(p, 45, h), 80 - 40 * 20 / 90.0, 1e-9) << h;
    EXPECT_NEAR(candela(p, 22.5, 90), 70, 1e-9);
    EXPECT_EQ(candela(p, 91, 30), 0);
    EXPECT_NEAR(p.maximum() / IesProfile::fromCandela, 100, 1e-9);
}

TEST(IesProfile, MultipliesBallastAndSkipsTilt) {
    std::string text = with(quarter(), "1 1000 1", "2 -1 3");
    text = with(text, "1 1 60", "0.5 0.8 60");
    text = with(text, "TILT=NONE", "TILT=INCLUDE\n1\n3\n0 45 90\n1 0.9\n0.8");
    EXPECT_NEAR(candela(IesProfile::read(text, ""), 45, 90), 40 * 1.2, 1e-9);
}

TEST(IesProfile, OfAnEvenLampIsItsCandela) {
    const std::string even =
        "IESNA:LM-63-1995\nTILT=NONE\n1,1000,1,2,1,1,2,0,0,0,\n1 1 0\n0 180\n0\n50,50";
    const auto p = std::make_shared<const IesProfile>(IesProfile::read(even, "even.ies"));
    EXPECT_NEAR(p->mean() / IesProfile::fromCandela, 50, 1e-9);
    EXPECT_NEAR(candela(*p, 180, 0), 50, 1e-9);
    const PointLight light{{}, Rgb(1.0f), p};
    EXPECT_NEAR(light.sample({0, 3, 4}, 0, 0).weight[0], 50 * 4 * pi / 177.83 / 25, 1e-6);
    EXPECT_NEAR(light.traits().intensity, 50 * 4 * pi / 177.83, 1e-6);
}

TEST(IesProfile, SaysWhatIsDamaged) {
    const std::string text = quarter();
    EXPECT_EQ(mistake("IESNA91\nsomething\n"),
              "lamp.ies:1: there is no line TILT=, so this is no photometric file of LM-63");
    EXPECT_EQ(mistake(with(text, "80", "8x0")),
              "lamp.ies:8: the candela at horizontal angle 0, vertical 45 is '8x0', which is no "
              "number");
    EXPECT_EQ(mistake(with(text, " 80", " -80")),
              "lamp.ies:8: the candela at horizontal angle 0, vertical 45 is -80, below 0");
    EXPECT_EQ(mistake(with(text, "0 45 90", "0 45 45")),
              "lamp.ies:6: vertical angle 3 of 3 is 45, not larger than the one before, 45");
    EXPECT_EQ(mistake(with(text, "0 45 90", "0 45 80")),
              "lamp.ies:6: the vertical angles go from 0 to 80; in a file of type C they go from 0 "
              "to 90, 0 to 180, or 90 to 180");
    EXPECT_EQ(mistake(with(text, "\n0 90\n", "\n0 100\n")),
              "lamp.ies:7: the horizontal angles go from 0 to 100; in a file of type C there is 0 "
              "alone, or they go from 0 to 90, 180 or 360, or from 90 to 270");
    EXPECT_EQ(mistake(with(text, "1 3 2 1", "1 3 2 2")),
              "lamp.ies:4: its photometric type is B (2); woodcock reads type C (1)");
    EXPECT_EQ(mistake(with(text, "1 3 2 1", "1 1 2 1")),
              "lamp.ies:4: the number of vertical angles is 1; it must be a whole number from 2 to "
              "10000");
    EXPECT_EQ(mistake(with(text, "100 40 20\n", "100 40\n")),
              "lamp.ies:10: the file ends before the candela at horizontal angle 90, vertical 90");
    EXPECT_EQ(mistake(text + "7\n"), "lamp.ies:10: there is more behind the last candela: '7'");
    EXPECT_EQ(mistake(with(text, "1 1000 1 ", "1 1000 1e300 ")),
              "lamp.ies:10: the candela times their factors are more than a float can hold");
}

}  // namespace
}  // namespace woodcock::test
