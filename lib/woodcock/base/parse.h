// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace woodcock {

// Parsers for words of a command line. Each throws Error{Usage} that says what was expected.

inline constexpr int largestImageSide = 65536;

/// "16:32": the half-open range of samples 16 to 31.
struct SampleRange {
    int first = 0, end = 0;
};
SampleRange parseSampleRange(std::string_view text);

/// "2/8": the tile of number 2 of 8, counted from 0.
struct TileNumber {
    int index = 0, count = 1;
};
TileNumber parseTileNumber(std::string_view text);

/// "960x540", or a width alone; then the height follows from the scene's own aspect ratio.
struct ImageSize {
    int width = 0;
    std::optional<int> height;
};
ImageSize parseImageSize(std::string_view text);

/// "x0,y0,x1,y1": pixels [x0, x1) x [y0, y1), y down.
struct PixelRectangle {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};
PixelRectangle parsePixelRectangle(std::string_view text);

/// Seconds of "90", "90s", "1.5m" or "2h": positive.
double parseDuration(std::string_view text);
/// For readers: "0.25 s", "7.3 s", "4 m 05 s", "2 h 07 m".
std::string formatDuration(double seconds);

/// A whole number from `lowest` to `highest`.
std::uint64_t parseCount(std::string_view text, std::uint64_t lowest, std::uint64_t highest);

/// A number from `lowest` to `highest`; a plus before it is allowed.
double parseNumber(std::string_view text, double lowest, double highest);

/// "40,120": the position of a sun: elevation from -90 to 90, and azimuth, in degrees.
std::pair<double, double> parseAngles(std::string_view text);

/// "1%" or "0.01": positive, at most 1.
double parseFraction(std::string_view text);

}  // namespace woodcock
