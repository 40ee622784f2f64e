// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/environment_map.h"

#include <gtest/gtest.h>

#include <functional>

#include "woodcock/base/random.h"
#include "woodcock/base/statistics.h"
#include "woodcock/light/light.h"

namespace woodcock::test {

using namespace light;

namespace {

EnvironmentMap image(int width, int height, const std::function<Rgb(int x, int y)>& pixel) {
    std::vector<float> pixels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (float v : pixel(x, y).c) pixels.push_back(v);
    return {width, height, pixels};
}

/// The direction of image position (u, v) in [0,1]^2: u from the left, v from the top.
Vec3d direction(double u, double v) {
    const double phi = 2 * pi * (u - 0.5), theta = pi * v;
    return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

/// A blue sky with a small sun of so many times its light, around a pixel.
EnvironmentMap sunny(int width, int height, int sunX, int sunY, double light) {
    const double top = std::cos(pi * sunY / height), bottom = std::cos(pi * (sunY + 1) / height);
    const double pixelsInSky = 2.0 * width / (top - bottom);
    return image(width, height, [&](int x, int y) {
        const int apart = (x - sunX + width) % width;
        const bool beside = y == sunY && (apart == 1 || apart == width - 1);
        const double share = x == sunX && y == sunY ? 0.8 : beside ? 0.1 : 0;
        return Rgb{0.2f, 0.3f, 0.5f} + Rgb(static_cast<float>(light / 3 * share * pixelsInSky));
    });
}

struct Named {
    const char* name;
    EnvironmentMap map;
    int width, height;
};

std::vector<Named> images() {
    std::vector<Named> all;
    const auto add = [&](const char* name, int w, int h,
                         const std::function<Rgb(int, int)>& pixel) {
        all.push_back({name, image(w, h, pixel), w, h});
    };
    add("noise", 16, 8, [](int x, int y) {
        const auto n = [&](int c) { return static_cast<float>(hashOf(1, x, y, c) % 100) / 10; };
        return Rgb{n(0), n(1), n(2)};
    });
    add("one pixel", 16, 8, [](int x, int y) { return Rgb(x == 5 && y == 3 ? 100.0f : 0.0f); });
    add("a pixel at the pole", 16, 8,
        [](int x, int y) { return Rgb(x == 2 && y == 0 ? 9.0f : 0.0f); });
    add("a pixel at the seam", 16, 8,
        [](int x, int y) { return Rgb(x == 0 && y == 5 ? 9.0f : 0.0f); });
    add("black rows", 12, 9,
        [](int x, int y) { return Rgb(y < 3 || y == 6 ? 0 : 1 + static_cast<float>(x)); });
    add("a pixel beside darkness", 8, 4, [](int x, int) { return Rgb(x == 7 ? 1e6f : 1e-6f); });
    add("one pixel wide and high", 1, 1, [](int, int) { return Rgb(2.0f); });
    const auto addParts = [&](const char* name, int w, int h, int x, int y) {
        EnvironmentMap sky = sunny(w, h, x, y, 2);
        auto sun = sky.takeSun();
        EXPECT_TRUE(sun) << name;
        if (sun) all.push_back({name, std::move(sun->map), w, h});
        all.push_back({"what is left of it", std::move(sky), w, h});
    };
    addParts("a sun", 256, 128, 100, 40);
    addParts("a sun at the seam", 256, 128, 255, 90);
    addParts("a sun near the pole", 256, 128, 3, 1);
    return all;
}

TEST(EnvironmentMap, CentreLooksAlongMinusZWithXToItsRightAndYUp) {
    const EnvironmentMap map = image(360, 180, [](int x, int y) {
        return Rgb{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0};
    });
    const auto expectAt = [&](Vec3d d, float column, float row) {
        EXPECT_NEAR(map.radiance(d)[0], column, 1e-3);
        EXPECT_NEAR(map.radiance(d)[1], row, 1e-3);
    };
    expectAt({0, 0, -1}, 180, 90);
    expectAt({1, 0, 0}, 270, 90);
    expectAt({-1, 0, 0}, 90, 90);
    expectAt({std::sin(2 * pi / 180), 0, std::cos(2 * pi / 180)}, 358, 90);  // the seam is behind
    expectAt(normalize(Vec3d{0, 1, -1}), 180, 45);
    EXPECT_NEAR(map.radiance({0, 1, 0})[1], 0.5, 1e-3);
    EXPECT_NEAR(map.radiance({0, -1, 0})[1], 179.5, 1e-3);
}

TEST(EnvironmentMap, RadianceIsBilinearAndWrapsAround) {
    const EnvironmentMap map =
        image(4, 2, [](int x, int y) { return Rgb(static_cast<float>(x + 10 * y)); });
    EXPECT_NEAR(map.radiance(direction(0.375, 0.25))[0], 1, 1e-6);
    EXPECT_NEAR(map.radiance(direction(0.5, 0.25))[0], 1.5, 1e-6);
    EXPECT_NEAR(map.radiance(direction(0.5, 0.5))[0], 6.5, 1e-6);
    EXPECT_NEAR(map.radiance(direction(1e-9, 0.25))[0], 1.5, 1e-6);  // between columns 3 and 0
    EXPECT_NEAR(map.radiance(direction(0.0625, 0.25))[0], 0.75, 1e-6);
    EXPECT_NEAR(map.radiance(direction(0.375, 0.01))[0], 1, 1e-6);  // clamped at the pole
}

TEST(EnvironmentMap, ASunThatIsTakenOutAndTheRestAreTheImage) {
    RandomStream random(4);
    for (const auto& [x, y] : {std::pair{100, 40}, {255, 90}, {0, 60}, {3, 1}, {77, 126}}) {
        const EnvironmentMap whole = sunny(256, 128, x, y, 2);
        EnvironmentMap rest = whole;
        const auto sun = rest.takeSun();
        ASSERT_TRUE(sun) << x << ' ' << y;
        const Vec3d middle = direction((x + 0.5) / 256, (y + 0.5) / 128);
        EXPECT_GT(dot(sun->direction, middle), std::cos(0.2 * pi / 180));
        for (int i = 0; i < 4000; ++i) {
            // Half of them are near the sun.
            const Vec3d anywhere = direction(random.uniform(), random.uniform());
            const Vec3d d = i % 2 ? anywhere : normalize(middle + anywhere * 0.06);
            const Rgb both = sun->map.radiance(d) + rest.radiance(d), all = whole.radiance(d);
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(both[c], all[c], 1e-5 * all[c]);
        }
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(sun->map.meanRadiance()[c] + rest.meanRadiance()[c],
                        whole.meanRadiance()[c], 1e-5 * whole.meanRadiance()[c]);
        // Of the sun's 2 / 3, no more is left than ten times the mean in three pixels.
        EXPECT_GT(sun->map.meanRadiance()[0], 0.99f * 2 / 3);
        EXPECT_FALSE(rest.takeSun()) << "a second time";
    }
}

TEST(EnvironmentMap, OnlyASunIsTakenOut) {
    const auto takes = [](EnvironmentMap map) { return map.takeSun().has_value(); };
    EXPECT_FALSE(takes({}));
    EXPECT_FALSE(takes(image(256, 128, [](int, int) { return Rgb(1.0f); })));
    EXPECT_FALSE(takes(image(256, 128, [](int, int) { return Rgb(0.0f); })));
    EXPECT_FALSE(takes(image(1, 1, [](int, int) { return Rgb(1.0f); })));
    // A cloud of a quarter of the sky, and a star of a hundredth of its light.
    EXPECT_FALSE(
        takes(image(256, 128, [](int x, int y) { return Rgb(x < 128 && y < 64 ? 9.0f : 0.1f); })));
    EXPECT_FALSE(takes(sunny(256, 128, 100, 40, 0.01)));
    EXPECT_TRUE(takes(sunny(256, 128, 100, 40, 0.1)));
}

TEST(EnvironmentMap, NoLightIsLeftUnsampled) {
    RandomStream random(2);
    for (const auto& [name, map, w, h] : images())
        for (int i = 0; i < 20000; ++i) {
            const Vec3d d = direction(random.uniform(), random.uniform());
            ASSERT_TRUE(map.pdf(d) > 0 || map.radiance(d).maximum() < 1e-12f) << name;
        }
}

/// What is sampled comes with its density: means of radiance over it are 4 pi times the mean.
TEST(EnvironmentMap, SamplesHaveTheirDensity) {
    constexpr int side = 256;
    for (const auto& [name, map, w, h] : images()) {
        double sum = 0;
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                const EnvironmentMap::Sample s = map.sample((i + 0.5) / side, (j + 0.5) / side);
                ASSERT_NEAR(map.pdf(s.direction), s.pdf, 1e-6 * s.pdf) << name;
                sum += double{map.radiance(s.direction).mean()} / s.pdf;
            }
        // Bilinear interpolation weighs rows a little otherwise than by their solid angle.
        const double light = double{map.meanRadiance().mean()} * 4 * pi;
        EXPECT_NEAR(sum / (side * side), light, (h > 100 ? 0.01 : 0.3) * light) << name;
    }
}

TEST(EnvironmentMap, EndsOfTheUnitIntervalAreSafe) {
    for (const auto& [name, map, w, h] : images())
        for (double u : {0.0, 1 - 0x1p-53})
            for (double v : {0.0, 1 - 0x1p-53}) {
                const EnvironmentMap::Sample s = map.sample(u, v);
                EXPECT_GT(s.pdf, 0) << name;
                EXPECT_NEAR(length(s.direction), 1, 1e-14);
            }
}

TEST(EnvironmentMap, ABlackImageIsNeverSampled) {
    const EnvironmentMap black = image(4, 2, [](int, int) { return Rgb(0.0f); });
    EXPECT_EQ(black.sample(0.5, 0.5).pdf, 0);
    EXPECT_EQ(black.pdf({0, 0, -1}), 0);
    EXPECT_EQ(black.meanRadiance(), Rgb(0.0f));
}

TEST(EnvironmentMap, MeanOfAnEvenImageIsItsValue) {
    const EnvironmentMap even = image(16, 9, [](int, int) { return Rgb{1, 2, 3}; });
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(even.meanRadiance()[c], c + 1, 1e-6);
}

TEST(Environment, ASunOfATurnedImageIsWhereItIsBright) {
    const Affine3d turn = Affine3d::rotate(1, 40) * Affine3d::rotate(0, 70);
    EnvironmentMap map = sunny(256, 128, 100, 40, 2);
    auto sun = map.takeSun();
    ASSERT_TRUE(sun);
    const Environment light(std::move(*sun), Rgb{1, 2, 3}, turn, true);
    const auto towards = light.traits().parallel;
    ASSERT_TRUE(towards);
    const LightSample s = light.sample({}, 0.5, 0.5);
    EXPECT_GT(dot(s.direction, *towards), std::cos(2 * pi / 180));
    EXPECT_GT(light.distantRadiance(*towards)[0], 100 * light.meanRadiance()[0]);
    EXPECT_FALSE(Environment(map, Rgb(1.0f), turn, true).traits().parallel);
}

TEST(Environment, ATurnedImageTurnsItsLight) {
    const Affine3d turn = Affine3d::rotate(1, 40) * Affine3d::rotate(0, 70);
    const EnvironmentMap map = images()[0].map;
    const Rgb scale{2, 1, 0.5};
    const Environment environment(map, scale, turn, true);
    RandomStream random(4);
    for (int i = 0; i < 1000; ++i) {
        const Vec3d d = direction(random.uniform(), random.uniform());
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(environment.radiance(turn.vector(d))[c], map.radiance(d)[c] * scale[c],
                        1e-4);
        const double u = random.uniform(), v = random.uniform();
        const LightSample s = environment.sample({}, u, v);
        EXPECT_LE(length(s.direction - turn.vector(map.sample(u, v).direction)), 1e-14);
        EXPECT_NEAR(s.weight[1], environment.radiance(s.direction)[1] / s.pdf, 1e-4);
    }
}

TEST(Environment, AConstantIsTheSameEverywhere) {
    const Environment environment(Rgb{1, 2, 3}, true);
    EXPECT_TRUE(environment.constant());
    EXPECT_EQ(environment.radiance({0, 1, 0}), (Rgb{1, 2, 3}));
    EXPECT_EQ(environment.meanRadiance(), (Rgb{1, 2, 3}));
    EXPECT_EQ(environment.pdf({}, {0, 1, 0}), 0);
}

}  // namespace
}  // namespace woodcock::test
