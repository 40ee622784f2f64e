// SPDX-License-Identifier: Apache-2.0
#include "woodcock/compare/comparison.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/compare/pictures.h"
#include "tests/support/expect_error.h"
#include "woodcock/base/statistics.h"

namespace woodcock::test {

using namespace compare;

namespace {

constexpr int width = 48, height = 40;

double slope(int x, int y) { return 0.5 + 0.01 * x + 0.02 * y; }
/// Noise that differs by a factor of eight over the picture.
double uneven(int x, int) { return 0.01 + 0.07 * x / width; }

enum class NoiseFrom { Errors, Seeds, Scatter };

Picture rendered(NoiseFrom from, double gain, std::mt19937_64& random) {
    const Picture clean =
        picture(width, height, {"R", "G"}, [gain](int x, int y) { return gain * slope(x, y); });
    if (from == NoiseFrom::Seeds) return meanOfSeeds(clean, uneven, 4, random);
    return noisy(clean, uneven, from == NoiseFrom::Errors, random);
}

/// Of `runs` comparisons, how many find a difference.
int found(NoiseFrom from, double gain, double falseAlarms, int runs) {
    std::mt19937_64 random(7);
    CompareSettings settings;
    settings.falseAlarms = falseAlarms;
    int count = 0;
    for (int i = 0; i < runs; ++i) {
        const Picture a = rendered(from, 1, random), b = rendered(from, gain, random);
        const Comparison c = compare::compare(both(a, b), settings);
        EXPECT_EQ(c.images.front().channels.front().errorsKnown, from != NoiseFrom::Scatter);
        if (c.images.front().differ) ++count;
    }
    return count;
}

// The means' half of the rate is met, the tiles' half undercut: caution only adds to their errors.
// Four standard errors of a binomial on either side.
TEST(FalseAlarms, AreAsRareAsStated) {
    constexpr int runs = 600;
    constexpr double rate = 0.2;
    const auto spread = [](double p) { return 4 * std::sqrt(p * (1 - p) * runs); };
    for (const NoiseFrom from : {NoiseFrom::Errors, NoiseFrom::Scatter}) {
        const int alarms = found(from, 1, rate, runs);
        EXPECT_LT(alarms, rate * runs + spread(rate)) << static_cast<int>(from);
        EXPECT_GT(alarms, rate / 2 * runs - spread(rate / 2)) << static_cast<int>(from);
    }
    // Satterthwaite's degrees of freedom are an approximation for errors from few seeds: it must
    // not raise the rate.
    EXPECT_LT(found(NoiseFrom::Seeds, 1, rate, runs), rate * runs + spread(rate));
}

// Rare bright samples, as of a path tracer with few: one pixel in five holds five times the light,
// against the exact expectation. Tiles that miss them are dark with little scatter.
TEST(FalseAlarms, StayRareWhereNoiseHasALongTail) {
    std::mt19937_64 random(13);
    std::exponential_distribution<double> bright;
    std::uniform_real_distribution<double> uniform;
    constexpr int runs = 400;
    constexpr double rate = 0.05;
    const Picture exact = picture(80, 80, {"R"}, [](int, int) { return 1.0; });
    CompareSettings settings;
    settings.falseAlarms = rate;
    int alarms = 0;
    for (int i = 0; i < runs; ++i) {
        const Picture rare = picture(80, 80, {"R"}, [&](int, int) {
            return uniform(random) < 0.2 ? 5 * bright(random) : 0.0;
        });
        if (!compare::compare(both(exact, rare), settings).images.front().tiles.empty()) ++alarms;
    }
    EXPECT_LE(alarms, rate * runs + 4 * std::sqrt(rate * (1 - rate) * runs));
}

// Ten standard errors of the mean: 1 % of a mean of 1.1 is 0.011; noise averages 0.045 sqrt(2)
// (root mean square 0.050 sqrt(2)) over 1920 pixels: 0.0016. Seeds halve that.
TEST(Power, OnePercentOfBrightnessIsFound) {
    for (const NoiseFrom from : {NoiseFrom::Errors, NoiseFrom::Seeds, NoiseFrom::Scatter})
        EXPECT_EQ(found(from, 1.01, 1e-3, 50), 50) << static_cast<int>(from);
}

TEST(Power, ADifferenceIsFoundWhereItIs) {
    std::mt19937_64 random(3);
    const auto even = [](int, int) { return 0.01; };
    const Picture clean = picture(width, height, {"R", "G"}, slope);
    Picture spot = picture(width, height, {"R", "G"}, [](int x, int y) {
        return slope(x, y) + (x >= 16 && x < 24 && y >= 8 && y < 16 ? 0.02 : 0.0);
    });
    spot.planes[1] = clean.planes[1];  // in R alone
    const Comparison c = compare::compare(
        both(noisy(clean, even, true, random), noisy(spot, even, true, random)), CompareSettings{});
    const ImageComparison& image = c.images.front();
    ASSERT_TRUE(image.differ);
    EXPECT_EQ(c.tiles, 30u);
    EXPECT_EQ(image.tests, 2 * 31u);
    EXPECT_EQ(image.differentTiles, 1u);
    ASSERT_EQ(image.tiles.size(), 1u);
    const TileDifference& t = image.tiles.front();
    EXPECT_EQ(image.channels[t.channel].name, "R");
    EXPECT_EQ(t.tile, 8u);
    EXPECT_EQ(t.place.x0, 16);
    EXPECT_EQ(t.place.y0, 8);
    EXPECT_EQ(t.place.x1, 24);
    EXPECT_EQ(t.place.y1, 16);
    EXPECT_NEAR(t.difference.error, 0.01 * std::sqrt(2.0) / 8, 1e-8);
    EXPECT_NEAR(t.difference.value, 0.02, 4 * t.difference.error);
    EXPECT_EQ(image.reason, "1 of 30 tiles");
}

TEST(Comparison, StandardErrorsAreThoseOfManyRuns) {
    std::mt19937_64 random(11);
    for (const bool known : {true, false}) {
        Moments biases, ratios;
        double biasError = 0, ratioError = 0;
        for (int i = 0; i < 400; ++i) {
            const Picture a = noisy(picture(width, height, {"R"}, slope), uneven, known, random);
            const Picture b =
                noisy(picture(width, height, {"R"}, [](int x, int y) { return 1.5 * slope(x, y); }),
                      uneven, known, random);
            const ChannelComparison c =
                compare::compare(both(a, b), CompareSettings{}).images.front().channels.front();
            biases.add(c.bias.value), ratios.add(c.ratio);
            biasError += c.bias.error / 400, ratioError += c.ratioError / 400;
        }
        // A standard deviation of 400 numbers is known to 1 / sqrt(800).
        const double deviation = std::sqrt(ratios.variance());
        EXPECT_NEAR(ratioError / deviation, 1, 4 / std::sqrt(800.0)) << known;
        EXPECT_NEAR(ratios.mean(), 1.5, 4 * ratios.standardError()) << known;
        if (known)  // scatter inside tiles also holds what the slope adds to the difference
            EXPECT_NEAR(biasError / std::sqrt(biases.variance()), 1, 4 / std::sqrt(800.0));
        else
            EXPECT_GE(biasError / std::sqrt(biases.variance()), 1 - 4 / std::sqrt(800.0));
    }
}

TEST(Comparison, EqualPicturesAreTheSame) {
    const Picture p = picture(width, height, {"R", "G", "B"}, slope);
    const ImageComparison image = compare::compare(both(p, p), CompareSettings{}).images.front();
    EXPECT_FALSE(image.differ);
    EXPECT_EQ(image.channels[0].ratio, 1);
    EXPECT_EQ(image.channels[0].bias.error, 0);
    EXPECT_EQ(image.channels[0].chance, 1);
    EXPECT_EQ(image.flip->ldr, 0);
}

TEST(Comparison, ConstantsDifferByMoreThanTheirDigits) {
    const auto flat = [](double v) { return picture(16, 16, {"R"}, [v](int, int) { return v; }); };
    const auto differ = [&](double a, double b, double resolution) {
        Picture p = flat(a);
        p.resolution = resolution;
        return compare::compare(both(p, flat(b)), CompareSettings{}).images.front().differ;
    };
    EXPECT_FALSE(differ(0.5, 0.5 * (1 + 3e-4), 0x1p-11));
    EXPECT_TRUE(differ(0.5, 0.5 * (1 + 6e-4), 0x1p-11));
    EXPECT_TRUE(differ(0.5, 0.5001, 0x1p-20));
    EXPECT_TRUE(differ(0, 1e-20, 0x1p-20));
}

// A pixel has a depth where one of its samples met something: more samples, more depth.
TEST(Comparison, DepthIsMeasuredAndNotTested) {
    const Picture a = picture(16, 16, {"R", "Z"}, [](int, int) { return 2.0; });
    Picture b = a;
    for (float& v : b.planes[1].values) v = 3;
    b.planes[1].values[0] = std::numeric_limits<float>::quiet_NaN();
    const Comparison c = compare::compare(both(a, b), CompareSettings{});
    const ImageComparison& image = c.images.front();
    EXPECT_FALSE(image.differ) << image.reason;
    EXPECT_TRUE(c.notes.empty());
    EXPECT_EQ(image.tests, 5u);
    EXPECT_EQ(image.channels[1].metrics.rmse, 1);
    EXPECT_EQ(image.channels[1].metrics.pixels, 255u);
    EXPECT_EQ(image.channels[1].metrics.nonFiniteB, 0u);
}

TEST(Comparison, NoFlipWithoutColour) {
    const Picture p = picture(16, 16, {"Z"}, slope);
    EXPECT_FALSE(compare::compare(both(p, p), CompareSettings{}).images.front().flip.has_value());
}

TEST(Comparison, NonFiniteValuesAreCountedAndLeftOut) {
    const Picture a = picture(16, 16, {"R", "G", "B"}, slope);
    Picture b = a;
    b.planes[1].values[5 + 16 * 3] = std::numeric_limits<float>::quiet_NaN();
    b.planes[1].values[6] = std::numeric_limits<float>::infinity();
    const Comparison c = compare::compare(both(a, b), CompareSettings{});
    const ImageComparison& image = c.images.front();
    EXPECT_TRUE(image.differ);
    EXPECT_NE(image.reason.find("2 values are NaN or infinite in only one of A and B"),
              std::string::npos)
        << image.reason;
    EXPECT_EQ(image.channels[1].metrics.nonFiniteB, 2u);
    EXPECT_EQ(image.channels[1].metrics.nonFiniteA, 0u);
    EXPECT_EQ(image.channels[1].metrics.pixels, 254u);
    EXPECT_EQ(image.channels[1].metrics.rmse, 0);
    EXPECT_EQ(image.differentTiles, 0u);
    ASSERT_EQ(c.notes.size(), 1u);
    EXPECT_NE(c.notes[0].find("B holds 2 NaN or infinite values, the first one inf in G at 6, 0"),
              std::string::npos)
        << c.notes[0];
}

TEST(Comparison, NothingFiniteIsAnError) {
    const Picture a = picture(8, 8, {"R"}, slope);
    const Picture b =
        picture(8, 8, {"R"}, [](int, int) { return std::numeric_limits<double>::quiet_NaN(); });
    expectError(ErrorKind::Input, "no pixel of channel R is finite in both",
                [&] { compare::compare(both(a, b), CompareSettings{}); });
}

TEST(Tiles, CoverThePictureOnce) {
    for (const auto& [w, h] : {std::pair{160, 90}, {7, 3}, {17, 8}, {1, 100}}) {
        const Tiles tiles(w, h, 8);
        std::vector<int> covered(static_cast<std::size_t>(w * h), 0);
        for (std::size_t t = 0; t < tiles.count(); ++t) {
            const auto [x0, y0, x1, y1] = tiles.tile(t);
            EXPECT_GE(x1 - x0, std::min(w, 8));
            EXPECT_GE(y1 - y0, std::min(h, 8));
            for (int y = y0; y < y1; ++y)
                for (int x = x0; x < x1; ++x) ++covered[static_cast<std::size_t>(y * w + x)];
        }
        EXPECT_EQ(std::count(covered.begin(), covered.end(), 1), w * h);
    }
}

// Holm: each further test has one competitor less.
TEST(TooSmall, GoesDownStepByStep) {
    const double one = 1 - std::pow(0.95, 1 / 3.0), two = 1 - std::pow(0.95, 1 / 2.0);
    EXPECT_EQ(tooSmall({0.5, one * 0.99, two * 0.99}, 0.05), (std::vector{false, true, true}));
    EXPECT_EQ(tooSmall({0.5, one * 1.01, two * 0.99}, 0.05), (std::vector{false, false, false}));
    EXPECT_EQ(tooSmall({0.5, one * 0.99, two * 1.01}, 0.05), (std::vector{false, true, false}));
    EXPECT_TRUE(tooSmall({}, 0.05).empty());
}

}  // namespace
}  // namespace woodcock::test
