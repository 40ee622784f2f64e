// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/solar_position.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "woodcock/base/vec.h"

namespace woodcock::light {
namespace {

constexpr double degree = pi / 180;

bool isLeap(int year) { return year % 4 == 0 && (year % 100 != 0 || year % 400 == 0); }

int daysOf(int year, int month) {
    constexpr int days[]{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    return days[month - 1] + (month == 2 && isLeap(year) ? 1 : 0);
}

/// The whole numbers between separators, of two digits each but the first, which may have four.
std::vector<int> numbersIn(std::string_view text, char separator, std::size_t firstDigits) {
    std::vector<int> numbers;
    for (std::size_t digits = firstDigits;; digits = 2) {
        int value = 0;
        for (std::size_t i = 0; i < digits; ++i) {
            if (i >= text.size() || text[i] < '0' || text[i] > '9') return {};
            value = 10 * value + (text[i] - '0');
        }
        numbers.push_back(value);
        text.remove_prefix(digits);
        if (text.empty()) return numbers;
        if (text.front() != separator) return {};
        text.remove_prefix(1);
    }
}

/// Days from noon of 1 January 2000, UTC. Meeus 1998, eq. 7.1.
double daysSince2000(const CivilTime& time) {
    const bool early = time.date.month <= 2;
    const int year = time.date.year - (early ? 1 : 0), month = time.date.month + (early ? 12 : 0);
    const int century = year / 100, leap = 2 - century + century / 4;
    const double midnight = std::floor(365.25 * (year + 4716)) + std::floor(30.6001 * (month + 1)) +
                            time.date.day + leap - 1524.5;
    return midnight - 2451545 + (time.hours - time.utcOffset) / 24;
}

CivilTime later(CivilTime time, double hours) {
    time.hours += hours;
    for (; time.hours >= 24; time.hours -= 24) {
        CalendarDate& d = time.date;
        if (++d.day > daysOf(d.year, d.month)) d.day = 1, ++d.month;
        if (d.month > 12) d.month = 1, ++d.year;
    }
    return time;
}

/// How much higher something seems to stand than it does, in degrees: Saemundsson, in Meeus 1998,
/// eq. 16.4. Further below the horizon, from where nothing is seen, it only fades.
double refraction(double elevation) {
    const double h = std::max(elevation, -1.0);
    const double lift = 1.02 / 60 / std::tan((h + 10.3 / (h + 5.11)) * degree);
    return std::max(0.0, lift) / std::max(1.0, -elevation);
}

}  // namespace

std::optional<CalendarDate> parseDate(std::string_view text) {
    const std::vector<int> n = numbersIn(text, '-', 4);
    if (n.size() != 3 || n[1] < 1 || n[1] > 12 || n[2] < 1 || n[2] > daysOf(n[0], n[1]))
        return std::nullopt;
    return CalendarDate{n[0], n[1], n[2]};
}

std::optional<double> parseTimeOfDay(std::string_view text) {
    std::vector<int> n = numbersIn(text, ':', 2);
    if (n.size() == 2) n.push_back(0);
    if (n.size() != 3 || n[0] > 23 || n[1] > 59 || n[2] > 59) return std::nullopt;
    return n[0] + n[1] / 60.0 + n[2] / 3600.0;
}

std::string dateText(const CalendarDate& date) {
    return fmt::format("{:04}-{:02}-{:02}", date.year, date.month, date.day);
}

std::string timeOfDayText(double hours) {
    const int seconds = static_cast<int>(std::lround(hours * 3600));
    return fmt::format("{:02}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60);
}

std::string timeText(const CivilTime& time) {
    CivilTime rounded = later(time, 0.5 / 60);
    const int minutes = static_cast<int>(rounded.hours * 60);
    return fmt::format("{} {:02}:{:02}", dateText(rounded.date), minutes / 60, minutes % 60);
}

SolarPosition solarPosition(const CivilTime& time, const EarthPlace& place) {
    const double days = daysSince2000(time);
    constexpr double terrestrialTime =
        70.0 / 86400;  // ahead of UTC, today; an hour is 0.04 degrees
    const double T = (days + terrestrialTime) / 36525;
    // Chapter 25: the sun's mean longitude and anomaly, its true and its apparent longitude.
    const double L0 = 280.46646 + T * (36000.76983 + T * 0.0003032);
    const double M = (357.52911 + T * (35999.05029 - T * 0.0001537)) * degree;
    const double C = (1.914602 - T * (0.004817 + T * 0.000014)) * std::sin(M) +
                     (0.019993 - T * 0.000101) * std::sin(2 * M) + 0.000289 * std::sin(3 * M);
    const double node = (125.04 - 1934.136 * T) * degree;
    const double longitude = (L0 + C - 0.00569 - 0.00478 * std::sin(node)) * degree;
    const double obliquity =
        (23.4392911 - T * (0.0130042 + T * (1.64e-7 - T * 5.04e-7)) + 0.00256 * std::cos(node)) *
        degree;
    const double rightAscension =
        std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
    const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));
    // Eq. 12.4, with the nutation of chapter 22, and chapter 13 with the azimuth from north.
    const double t = days / 36525;
    const double sidereal = 280.46061837 + 360.98564736629 * days + t * t * 0.000387933 -
                            0.00478 * std::sin(node) * std::cos(obliquity);
    const double hourAngle = (sidereal + place.longitude) * degree - rightAscension;
    const double latitude = place.latitude * degree;
    const double up = std::sin(latitude) * std::sin(declination) +
                      std::cos(latitude) * std::cos(declination) * std::cos(hourAngle);
    const double east = -std::cos(declination) * std::sin(hourAngle);
    const double north = std::cos(latitude) * std::sin(declination) -
                         std::sin(latitude) * std::cos(declination) * std::cos(hourAngle);
    const double elevation = std::atan2(up, std::hypot(east, north)) / degree;
    const double azimuth = std::atan2(east, north) / degree;
    return {elevation + refraction(elevation), azimuth < 0 ? azimuth + 360 : azimuth};
}

std::optional<CivilTime> nextSunrise(const CivilTime& time, const EarthPlace& place) {
    const auto isUp = [&](double hours) {
        return solarPosition(later(time, hours), place).elevation >= 0;
    };
    constexpr double step = 1.0 / 6;
    bool wasUp = isUp(0);
    for (double hours = step; hours < 366 * 24; hours += step) {
        const bool nowUp = isUp(hours);
        if (nowUp && !wasUp) {
            double down = hours - step, up = hours;
            while (up - down > 1e-4) ((isUp((down + up) / 2)) ? up : down) = (down + up) / 2;
            return later(time, up);
        }
        wasUp = nowUp;
    }
    return std::nullopt;
}

}  // namespace woodcock::light
