// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace woodcock::light {

/// A day of the Gregorian calendar.
struct CalendarDate {
    int year = 2000, month = 1, day = 1;
    bool operator==(const CalendarDate&) const = default;
};
/// A time of day, in hours from 0 to 24, as a clock shows it.
struct CivilTime {
    CalendarDate date;
    double hours = 12;
    double utcOffset = 0;  ///< hours that the clock is ahead of UTC, summer time included
    bool operator==(const CivilTime&) const = default;
};

inline constexpr int firstYear = 1800, lastYear = 2200;

/// "2026-06-21"; nothing where the text is no date, or the calendar has no such day.
std::optional<CalendarDate> parseDate(std::string_view text);
/// Hours of "14:30" or "14:30:15"; nothing where it is no time of day.
std::optional<double> parseTimeOfDay(std::string_view text);
std::string dateText(const CalendarDate& date);
/// "14:30:15", rounded to the second.
std::string timeOfDayText(double hours);
/// "2026-06-21 14:30", rounded to the minute.
std::string timeText(const CivilTime& time);

/// Degrees; north and east are positive.
struct EarthPlace {
    double latitude = 0, longitude = 0;
    bool operator==(const EarthPlace&) const = default;
};
struct SolarPosition {
    double elevation;  ///< degrees above the horizon, as seen through the air (refraction)
    double azimuth;    ///< degrees, from north by east
};

/// Meeus, "Astronomical Algorithms" (1998), chapters 12, 13, 16 and 25: to 0.01 degrees from
/// `firstYear` to `lastYear`, beside what the air's weather does close to the horizon.
SolarPosition solarPosition(const CivilTime& time, const EarthPlace& place);

/// The next moment after `time` at which the sun's centre rises over the horizon, within a year;
/// nothing where the sun does not rise.
std::optional<CivilTime> nextSunrise(const CivilTime& time, const EarthPlace& place);

}  // namespace woodcock::light
