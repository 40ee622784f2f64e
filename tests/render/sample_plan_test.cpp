// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/sample_plan.h"

#include <gtest/gtest.h>

#include <functional>
#include <numeric>

#include "tests/support/expect_estimate.h"
#include "woodcock/base/random.h"

namespace woodcock::test {

using namespace image;
using namespace proof;
using namespace render;

namespace {

constexpr int width = 9, height = 7, pilotSamples = 4;
constexpr Film::Window crop{2, 1, 2 + width, 1 + height};

using Draw = std::function<float(int x, int y, RandomStream&)>;

void addSample(Film& film, int x, int y, const Draw& draw, RandomStream& random) {
    film.add(x, y, FilmSample{Rgb(draw(x, y, random)), 1});
}

Film pilotOf(const Draw& draw, RandomStream& random) {
    Film film(20, 10, crop);
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x)
            for (int i = 0; i < pilotSamples; ++i) addSample(film, x, y, draw, random);
    return film;
}

/// Of mean 1, and 0 fifteen times in sixteen.
float rare(int, int, RandomStream& random) { return random.uniform() < 1.0 / 16 ? 16.0f : 0.0f; }

std::size_t indexOf(int x, int y) {
    return static_cast<std::size_t>((y - crop.y0) * width + x - crop.x0);
}

std::uint64_t sum(const std::vector<std::uint32_t>& counts) {
    return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

TEST(SamplePlan, GivesAwayAllSamplesAndTakesNoneBack) {
    RandomStream random(1);
    const SamplePlan plan(pilotOf(rare, random), pilotSamples);
    std::vector<std::uint32_t> before(width * height, 0);
    for (int mean = 1; mean < 300; ++mean) {
        const auto counts = plan.counts(mean);
        // All cost alike, so the work is the number.
        ASSERT_EQ(sum(counts), static_cast<std::uint64_t>(mean * width * height));
        for (std::size_t i = 0; i < counts.size(); ++i) {
            ASSERT_GE(counts[i], before[i]) << mean;
            if (mean >= pilotSamples) {
                ASSERT_GE(counts[i], pilotSamples);
            }
        }
        before = counts;
    }
    EXPECT_EQ(sum(plan.counts(1 << 24)), (std::uint64_t{1} << 24) * width * height);
}

/// Samples of a pixel at the left edge over those of one at the right edge, far from where the
/// picture's halves meet.
double leftOverRight(const std::function<FilmSample(bool left, RandomStream&)>& draw) {
    constexpr int wide = 40, samples = 4000;
    RandomStream random(2);
    Film pilot(wide, height, {0, 0, wide, height});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < wide; ++x)
            for (int i = 0; i < samples; ++i) pilot.add(x, y, draw(x < wide / 2, random));
    const auto counts = SamplePlan(pilot, samples).counts(10 * samples);
    return static_cast<double>(counts[3 * wide]) / counts[4 * wide - 1];
}

TEST(SamplePlan, GoesInProportionToTheRelativeError) {
    // Deviation / mean is 1 / 4 in the left half and 1 in the right, which is the darker one.
    const auto draw = [](bool left, RandomStream& random) {
        const float sign = random.uniform() < 0.5 ? -1.0f : 1.0f;
        return FilmSample{Rgb(left ? 8 + 2 * sign : 3 + 3 * sign), 1};
    };
    EXPECT_NEAR(1 / leftOverRight(draw), 4, 0.2);
}

TEST(SamplePlan, WhatIsDearGetsFewerByTheRootOfItsCost) {
    // A sample of the left half costs 1, one of the right half, with eight events, 1 + 8 x 10 = 81.
    const auto draw = [](bool left, RandomStream& random) {
        return FilmSample{Rgb(random.uniform() < 0.5 ? 1.0f : 3.0f), 1, left ? 0.0f : 8.0f};
    };
    EXPECT_NEAR(leftOverRight(draw), 9, 0.2);
}

/// The middle of a picture holds noisy smoke whose paths have one event; around it is nothing.
FilmSample smokeInTheMiddle(int x, int y, RandomStream& random) {
    if (std::abs(x - 20) > 6 || std::abs(y - 20) > 6) return FilmSample{};
    return FilmSample{Rgb(random.uniform() < 0.3 ? 3.0f : 0.1f), 1, 1};
}

TEST(SamplePlan, AllTogetherAreTheWorkOfEvenSamples) {
    constexpr int size = 41, samples = 64, even = 256;
    RandomStream random(6);
    Film pilot(size, size, {0, 0, size, size});
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            for (int i = 0; i < samples; ++i) pilot.add(x, y, smokeInTheMiddle(x, y, random));
    const auto counts = SamplePlan(pilot, samples).counts(even);
    double work = 0, evenWork = 0, smoke = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const bool middle = pilot.alpha(x, y) > 0;
            const double cost = middle ? 1 + 10.0 : 1,
                         n = counts[static_cast<std::size_t>(y * size + x)];
            work += n * cost, evenWork += even * cost;
            if (middle) smoke += n / (13 * 13);
        }
    // The plan smooths costs over the smoke's edge.
    EXPECT_NEAR(work / evenWork, 1, 0.05);
    // By costs: 1512 pixels of 1 and 169 of 11, of which the former keep the pilot's quarter.
    const double most = even + (even - samples) * 1512 / (169.0 * 11);
    EXPECT_GT(smoke, 0.93 * most);
    EXPECT_LT(smoke, 1.02 * most);
}

/// Samples of a pixel in fog that one ray in a hundred meets, over those of one in thick fog.
TEST(SamplePlan, FaintEdgesAreAsPlainWithAHiddenBackground) {
    constexpr int wide = 40, samples = 4000;
    const auto ratio = [](bool visible) {
        RandomStream random(7);
        Film pilot(wide, height, {0, 0, wide, height}, {false, false, visible});
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < wide; ++x)
                for (int i = 0; i < samples; ++i) {
                    const bool met = random.uniform() < (x < wide / 2 ? 0.01 : 1.0);
                    const float light = random.uniform() < 0.5 ? 0.5f : 1.5f;
                    const Rgb sky(visible ? 1.0f : 0.0f);
                    pilot.add(x, y, met ? FilmSample{Rgb(light), 1} : FilmSample{sky, 0, 0, sky});
                }
        const auto counts = SamplePlan(pilot, samples).counts(20 * samples);
        return static_cast<double>(counts[3 * wide]) / counts[4 * wide - 1];
    };
    // Variances of 0.01 x 0.25 before a sky as bright as the fog, of 0.01 x 1.25 before a hidden
    // one, and of 0.25 in thick fog, all relative to the fog's brightness.
    EXPECT_NEAR(ratio(true), std::sqrt(0.01), 0.01);
    EXPECT_NEAR(ratio(false), std::sqrt(0.01 * 1.25 / 0.25), 0.02);
}

TEST(SamplePlan, EvenPicturesGetEvenSamples) {
    for (const float light : {0.0f, 3.0f}) {
        RandomStream random(3);
        const Draw draw = [&](int, int, RandomStream&) { return light; };
        const auto counts = SamplePlan(pilotOf(draw, random), pilotSamples).counts(50);
        EXPECT_EQ(counts, std::vector<std::uint32_t>(width * height, 50));
    }
}

TEST(SamplePlan, OnePixelGetsAll) {
    Film pilot(3, 3, {1, 1, 2, 2});
    pilot.add(1, 1, FilmSample{Rgb(1.0f), 1}), pilot.add(1, 1, FilmSample{Rgb(2.0f), 1});
    EXPECT_EQ(SamplePlan(pilot, 2).counts(7), std::vector<std::uint32_t>{7});
}

/// The reason why it is unbiased: what a pixel gets has nothing to do with its own samples.
TEST(SamplePlan, APixelsNumberIsIndependentOfItsSamples) {
    RandomStream random(4);
    const Film pilot = pilotOf(rare, random);
    const auto counts = SamplePlan(pilot, pilotSamples).counts(64);
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x) {
            Film other = pilot;
            Film::Pixel& p = other.at(x, y);
            for (int c = 0; c < 3; ++c) p.radiance[c] += 160, p.radianceSquared[c] += 160 * 160;
            const auto otherCounts = SamplePlan(other, pilotSamples).counts(64);
            EXPECT_EQ(otherCounts[indexOf(x, y)], counts[indexOf(x, y)]);
            EXPECT_NE(otherCounts, counts);
        }
}

/// Means of all pixels of many renders of a mean-1 picture, of which `countsOf(pilot, mean 16)`
/// says how many samples each pixel gets.
Estimate meanOfRenders(
    int renders, const std::function<std::vector<std::uint32_t>(const Film&, int)>& countsOf) {
    Moments means;
    for (int i = 0; i < renders; ++i) {
        RandomStream random(hashOf(5, i));
        Film film = pilotOf(rare, random);
        const auto counts = countsOf(film, 16);
        double total = 0;
        for (int y = crop.y0; y < crop.y1; ++y)
            for (int x = crop.x0; x < crop.x1; ++x) {
                while (film.at(x, y).samples < counts[indexOf(x, y)])
                    addSample(film, x, y, rare, random);
                total += film.radiance(x, y)[0];
            }
        means.add(total / (width * height));
    }
    return Estimate(means);
}

/// The rest of the samples in proportion to each pixel's own standard error.
std::vector<std::uint32_t> naiveCounts(const Film& pilot, int mean) {
    std::vector<double> errors;
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x) {
            const Film::Pixel& p = pilot.at(x, y);
            const auto n = static_cast<double>(p.samples);
            errors.push_back(std::sqrt(
                std::max(0.0, p.radianceSquared[0] / n - std::pow(p.radiance[0] / n, 2))));
        }
    const double all = std::accumulate(errors.begin(), errors.end(), 0.0);
    std::vector<std::uint32_t> counts;
    for (const double e : errors)
        counts.push_back(
            pilotSamples +
            (all > 0 ? static_cast<std::uint32_t>(e / all * width * height * (mean - pilotSamples))
                     : 0));
    return counts;
}

TEST(SamplePlan, MeansOfRareBrightSamplesAreUnbiased) {
    const Estimate planned = meanOfRenders(4000, [](const Film& pilot, int mean) {
        return SamplePlan(pilot, pilotSamples).counts(mean);
    });
    expectAgrees(planned, 1, 0.004);
    // The test would see the bias of deciding by a pixel's own samples.
    const Estimate naive = meanOfRenders(400, naiveCounts);
    EXPECT_LT(naive.mean, 1 - 40 * planned.error);
    EXPECT_LT(naive.mean, 0.9);
}

}  // namespace
}  // namespace woodcock::test
