// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/parse.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "woodcock/base/error.h"

namespace woodcock {

namespace {

template <class T>
std::optional<T> number(std::string_view text) {
    T value{};
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end) return std::nullopt;
    return value;
}

/// Exactly N integers with `separator` between them.
template <std::size_t N>
std::optional<std::array<int, N>> integers(std::string_view text, char separator) {
    std::array<int, N> values;
    for (std::size_t i = 0; i < N; ++i) {
        const std::size_t end = i + 1 < N ? text.find(separator) : text.size();
        if (end == std::string_view::npos) return std::nullopt;
        const std::optional<int> value = number<int>(text.substr(0, end));
        if (!value) return std::nullopt;
        values[i] = *value;
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return values;
}

double positive(std::optional<double> value, double unit) {
    return value && std::isfinite(*value * unit) && *value > 0 ? *value * unit : 0;
}

}  // namespace

SampleRange parseSampleRange(std::string_view text) {
    const auto ends = integers<2>(text, ':');
    if (!ends || (*ends)[0] < 0 || (*ends)[1] <= (*ends)[0])
        throw usageError(
            "'{}' is not a range of samples; expected FIRST:END with 0 <= FIRST < END <= {}, "
            "such as 0:16",
            text, std::numeric_limits<int>::max());
    return {(*ends)[0], (*ends)[1]};
}

ImageSize parseImageSize(std::string_view text) {
    const auto valid = [](int n) { return n >= 1 && n <= largestImageSide; };
    if (const auto width = number<int>(text); width && valid(*width)) return {*width, {}};
    if (const auto both = integers<2>(text, 'x'); both && valid((*both)[0]) && valid((*both)[1]))
        return {(*both)[0], (*both)[1]};
    throw usageError(
        "'{}' is not an image size; expected WIDTHxHEIGHT or WIDTH, each 1 to {}, such as 960x540",
        text, largestImageSide);
}

TileNumber parseTileNumber(std::string_view text) {
    const auto tile = integers<2>(text, '/');
    if (!tile || (*tile)[0] < 0 || (*tile)[0] >= (*tile)[1])
        throw usageError(
            "'{}' is not a tile; expected INDEX/COUNT, where INDEX goes from 0 to COUNT - 1, such "
            "as 0/4",
            text);
    return {(*tile)[0], (*tile)[1]};
}

PixelRectangle parsePixelRectangle(std::string_view text) {
    const auto p = integers<4>(text, ',');
    if (!p || (*p)[0] < 0 || (*p)[1] < 0 || (*p)[2] <= (*p)[0] || (*p)[3] <= (*p)[1])
        throw usageError(
            "'{}' is not a rectangle of pixels; expected X0,Y0,X1,Y1 with 0 <= X0 < X1 and "
            "0 <= Y0 < Y1, such as 0,0,480,270",
            text);
    return {(*p)[0], (*p)[1], (*p)[2], (*p)[3]};
}

double parseDuration(std::string_view text) {
    std::string_view digits = text;
    double unit = 1;
    if (!text.empty()) {
        const char last = text.back();
        if (last == 'm') unit = 60;
        if (last == 'h') unit = 3600;
        if (last == 's' || last == 'm' || last == 'h') digits.remove_suffix(1);
    }
    const double seconds = positive(number<double>(digits), unit);
    if (seconds == 0)
        throw usageError(
            "'{}' is not a duration; expected a positive number of seconds, or one with s, m or "
            "h, such as 90s or 1.5h",
            text);
    return seconds;
}

std::string formatDuration(double seconds) {
    if (seconds < 0.995) return fmt::format("{:.2f} s", seconds);
    if (seconds < 59.95) return fmt::format("{:.1f} s", seconds);
    if (!(seconds < 1e9)) return "ages";
    const long whole = std::lround(seconds);
    if (whole < 3600) return fmt::format("{} m {:02} s", whole / 60, whole % 60);
    const long minutes = std::lround(seconds / 60);
    return fmt::format("{} h {:02} m", minutes / 60, minutes % 60);
}

std::uint64_t parseCount(std::string_view text, std::uint64_t lowest, std::uint64_t highest) {
    const auto count = number<std::uint64_t>(text);
    if (!count || *count < lowest || *count > highest)
        throw usageError("'{}' is not a whole number from {} to {}", text, lowest, highest);
    return *count;
}

double parseNumber(std::string_view text, double lowest, double highest) {
    const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
    const auto value = number<double>(text.substr(plus ? 1 : 0));
    if (!value || !(*value >= lowest && *value <= highest))
        throw usageError("'{}' is not a number from {} to {}", text, lowest, highest);
    return *value;
}

std::pair<double, double> parseAngles(std::string_view text) {
    const std::size_t comma = text.find(',');
    try {
        if (comma == std::string_view::npos) throw usageError("");
        return {parseNumber(text.substr(0, comma), -90, 90),
                parseNumber(text.substr(comma + 1), -3600, 3600)};
    } catch (const Error&) {
        throw usageError(
            "'{}' is not a position of the sun; expected ELEVATION,AZIMUTH in degrees, such as "
            "40,120: "
            "elevation from -90 to 90, azimuth 0 towards -z (towards +y where z is up), 90 towards "
            "+x",
            text);
    }
}

double parseFraction(std::string_view text) {
    std::string_view digits = text;
    const bool percent = !text.empty() && text.back() == '%';
    if (percent) digits.remove_suffix(1);
    const double fraction = positive(number<double>(digits), percent ? 0.01 : 1);
    if (fraction == 0 || fraction > 1)
        throw usageError(
            "'{}' is not a fraction; expected a positive number up to 1 (100%), such as 1% or 0.01",
            text);
    return fraction;
}

}  // namespace woodcock
