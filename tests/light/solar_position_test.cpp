// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/solar_position.h"

#include <gtest/gtest.h>

#include <cmath>

namespace woodcock::test {

using namespace light;

namespace {

CivilTime moment(const char* date, const char* time, double utcOffset) {
    return {parseDate(date).value(), parseTimeOfDay(time).value(), utcOffset};
}

// NREL's algorithm (Reda and Andreas 2004, to 0.0003 degrees) as pvlib 0.16.1 computes it, at sea
// level, 1010 hPa, 10 degrees Celsius. The first is the place and the moment of its report, table
// A4.1, whose azimuth is 194.34024.
TEST(SolarPosition, AgreesWithTheAlmanac) {
    const struct {
        CivilTime time;
        EarthPlace place;
        double elevation, azimuth;
    } known[]{
        {moment("2003-10-17", "12:30:30", -7), {39.742476, -105.1786}, 39.8922, 194.3402},
        {moment("2026-06-21", "14:30", 2), {48.8566, 2.3522}, 63.5279, 199.6312},
        {moment("2026-12-21", "09:15", 0), {51.4779, 0}, 7.1120, 142.8850},
        {moment("2026-03-20", "18:00", 10), {-33.8688, 151.2093}, 1.0132, 270.2765},
        {moment("2026-02-14", "12:00", -3), {-22.9068, -43.1729}, 79.8438, 9.4412},
        {moment("2101-08-01", "16:45", 9), {35.6762, 139.6503}, 22.9745, 276.2761},
        {moment("2024-06-21", "00:30", 2), {69.6492, 18.9553}, 3.3515, 356.3298},
        {moment("1850-05-05", "10:00", 0), {0, 0}, 57.0253, 59.1615},
    };
    for (const auto& k : known) {
        const SolarPosition sun = solarPosition(k.time, k.place);
        EXPECT_NEAR(sun.elevation, k.elevation, 0.02) << timeText(k.time);
        const double across = std::cos(k.elevation * 3.14159265 / 180);
        EXPECT_NEAR(sun.azimuth * across, k.azimuth * across, 0.02) << timeText(k.time);
    }
}

TEST(SolarPosition, StandsOverTheEquatorAtNoonOfAnEquinox) {
    // 20 March 2026: the equinox is at 14:46 UTC, and the equation of time is -7.4 minutes.
    const SolarPosition sun = solarPosition(moment("2026-03-20", "12:07:24", 0), {0, 0});
    EXPECT_NEAR(sun.elevation, 90, 0.1);
}

TEST(SolarPosition, FindsTheNextSunrise) {
    // The centre of the sun, as refraction shows it, rises some minutes after its upper limb, whose
    // rise almanacs give: in Greenwich on 21 December 2026 at 08:04.
    const auto rise = nextSunrise(moment("2026-12-21", "02:00", 0), {51.4779, 0});
    ASSERT_TRUE(rise);
    EXPECT_EQ(rise->date, (CalendarDate{2026, 12, 21}));
    EXPECT_NEAR(rise->hours * 60, 8 * 60 + 4 + 2.5, 2.5);
    EXPECT_NEAR(solarPosition(*rise, {51.4779, 0}).elevation, 0, 0.01);
    // In the evening it is the next day's, also at the year's end.
    const auto next = nextSunrise(moment("2026-12-31", "22:00", 0), {51.4779, 0});
    ASSERT_TRUE(next);
    EXPECT_EQ(next->date, (CalendarDate{2027, 1, 1}));
    // In the polar night of Tromsoe it takes until January.
    const auto polar = nextSunrise(moment("2026-12-01", "12:00", 1), {69.6492, 18.9553});
    ASSERT_TRUE(polar);
    EXPECT_EQ(polar->date.year, 2027);
    EXPECT_EQ(polar->date.month, 1);
    EXPECT_NEAR(polar->date.day, 15, 3);
}

TEST(SolarPosition, KnowsTheCalendar) {
    EXPECT_EQ(parseDate("2024-02-29"), (CalendarDate{2024, 2, 29}));
    EXPECT_EQ(parseDate("2000-02-29"), (CalendarDate{2000, 2, 29}));
    for (const char* wrong : {"2026-02-30", "2026-02-29", "1900-02-29", "2026-13-01", "2026-00-10",
                              "2026-04-31", "2026-06-00", "26-06-21", "2026-6-21", "2026/06/21",
                              "2026-06-21 ", "2026-06", "", "x", "2026-06-21-01", "-2026-06-21"})
        EXPECT_FALSE(parseDate(wrong)) << wrong;
    EXPECT_EQ(parseTimeOfDay("14:30"), 14.5);
    EXPECT_EQ(parseTimeOfDay("00:00:00"), 0);
    EXPECT_NEAR(parseTimeOfDay("23:59:59").value(), 24 - 1 / 3600.0, 1e-9);
    for (const char* wrong :
         {"24:00", "14:60", "14:30:60", "1430", "2:30", "14", "", "14:30:", "14:30pm", "-1:30"})
        EXPECT_FALSE(parseTimeOfDay(wrong)) << wrong;
    EXPECT_EQ(timeText(moment("2026-12-31", "23:59:40", 0)), "2027-01-01 00:00");
    EXPECT_EQ(timeText(moment("2028-02-28", "09:05:10", 0)), "2028-02-28 09:05");
}

}  // namespace
}  // namespace woodcock::test
