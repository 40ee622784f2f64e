// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/light_set.h"

#include <gtest/gtest.h>

#include <numeric>

#include "woodcock/base/random.h"

namespace woodcock::test {

using namespace light;

namespace {

EnvironmentMap twoPixels() { return {2, 1, {1, 2, 3, 4, 5, 6}}; }

/// A constant environment, then one of every kind that is sampled.
LightSet oneOfEach() {
    return LightSet({Environment(Rgb(1.0f), true), Sun({0, -1, 0}, Rgb(3.0f), 0.5, false),
                     Environment(twoPixels(), Rgb(1.0f), Affine3d{}, false),
                     PointLight{{3, 0, 0}, Rgb(10.0f)}, SphereLight{{0, 5, 0}, 1, Rgb(4.0f)}});
}

TEST(LightSet, SamplesAllButConstantEnvironments) {
    const LightSet lights = oneOfEach();
    EXPECT_EQ(std::vector<int>(lights.sampled().begin(), lights.sampled().end()),
              (std::vector<int>{1, 2, 3, 4}));
    EXPECT_EQ(std::vector<int>(lights.local().begin(), lights.local().end()),
              (std::vector<int>{3, 4}));
    EXPECT_TRUE(LightSet().sampled().empty());
}

TEST(LightSet, PickProbabilitiesSumToOneAndNeglectNoLight) {
    const LightSet lights = oneOfEach();
    RandomStream random(1);
    std::vector<float> p(4);
    for (int i = 0; i < 2000; ++i) {
        const auto r = [&] { return 2 * random.uniform() - 1; };
        Vec3d position{20 * r(), 20 * r(), 20 * r()};
        if (i == 0) position = {0, 5, 0};  // inside the sphere
        const medium::PhaseFunction any = medium::HenyeyGreenstein(0.999 * r());
        lights.pickProbabilities({position, normalize(Vec3d{r(), r(), r()}), &any}, p);
        EXPECT_NEAR(std::accumulate(p.begin(), p.end(), 0.0), 1, 1e-6);
        for (float v : p) EXPECT_GT(v, 0);
    }
}

TEST(LightSet, PicksFollowWhatEachLightWouldSend) {
    const LightSet lights({PointLight{{0, 0, 2}, Rgb(4.0f)}, PointLight{{0, 3, 0}, Rgb(27.0f)}});
    std::vector<float> p(2);
    const medium::PhaseFunction narrow = medium::HenyeyGreenstein(0.7);
    const medium::PhaseFunction wide = medium::HenyeyGreenstein(0.5);
    lights.pickProbabilities({{}, {1, 0, 0}, &narrow},
                             p);  // 4 / 2^2 and 27 / 3^2, at the same angle
    EXPECT_NEAR(p[0], 0.25, 1e-6);
    const auto phase = [](double cosine) { return std::pow(1.25 - cosine, -1.5); };  // g = 0.5
    lights.pickProbabilities({{}, {0, 0, 1}, &wide}, p);
    EXPECT_NEAR(p[0] / p[1], phase(1) / phase(0) / 3, 1e-5);
}

TEST(LightSet, DarkLightsAreNotPickedAndAllDarkIsZero) {
    const LightSet lights({PointLight{{0, 0, 2}, Rgb(0.0f)}, PointLight{{0, 3, 0}, Rgb(1.0f)}});
    std::vector<float> p(2);
    lights.pickProbabilities({{}, {0, 0, 1}}, p);
    EXPECT_EQ(p, (std::vector<float>{0, 1}));
    LightSet({PointLight{{0, 0, 2}, Rgb(0.0f)}, Sun({1, 0, 0}, Rgb(0.0f), 1, true)})
        .pickProbabilities({{}, {0, 0, 1}}, p);
    EXPECT_EQ(p, (std::vector<float>{0, 0}));
}

TEST(LightSet, DistantRadianceRespectsVisibilityToTheCamera) {
    const LightSet lights = oneOfEach();
    const Vec3d up{0, 1, 0};
    EXPECT_EQ(lights.distantRadiance(0, up, true), Rgb(1.0f));
    EXPECT_EQ(lights.distantRadiance(1, up, true), Rgb(0.0f));
    EXPECT_GT(lights.distantRadiance(1, up, false)[0], 0);
    EXPECT_EQ(lights.distantRadiance(1, {1, 0, 0}, false), Rgb(0.0f));
    EXPECT_EQ(lights.distantRadiance(2, up, true), Rgb(0.0f));
    EXPECT_GT(lights.distantRadiance(2, up, false)[0], 0);
    EXPECT_EQ(lights.distantRadiance(3, up, false), Rgb(0.0f));
    EXPECT_EQ(lights.distantRadiance(4, up, false), Rgb(0.0f));
}

TEST(LightSet, SamplingIsThatOfTheLight) {
    const LightSet lights = oneOfEach();
    const Vec3d from{1, 1, 1};
    RandomStream random(2);
    for (int light = 1; light < 5; ++light)
        for (int i = 0; i < 200; ++i) {
            const LightSample s =
                lights.sample(light, from, 0.99 * random.uniform(), 0.01 + 0.98 * random.uniform());
            EXPECT_NEAR(lights.pdf(light, from, s.direction), s.pdf, 1e-9 * s.pdf) << light;
            EXPECT_GT(s.weight[0], 0);
        }
}

TEST(LightSet, ListsLightsByWhatTheyAre) {
    FlatLight flat{};
    flat.x = {1, 0, 0}, flat.y = {0, 1, 0}, flat.normal = {0, 0, 1};
    flat.halfX = flat.halfY = 1, flat.radiance = Rgb(1.0f);
    const LightSet lights({SpotLight({}, {0, 0, 1}, Rgb(1.0f), 30, 0), RectangleLight{flat},
                           Sun({0, -1, 0}, Rgb(1.0f), 0, false), DiskLight{flat},
                           Environment(Rgb(1.0f), false), SphereLight{{}, 1, Rgb(1.0f)}});
    const auto list = [](std::span<const int> indices) {
        return std::vector<int>(indices.begin(), indices.end());
    };
    EXPECT_EQ(list(lights.local()), (std::vector<int>{0, 1, 3, 5}));
    EXPECT_EQ(list(lights.meetable()), (std::vector<int>{1, 3, 5}));
    EXPECT_EQ(list(lights.distant()), (std::vector<int>{4}));
    EXPECT_EQ(list(lights.sampled()), (std::vector<int>{0, 1, 2, 3, 5}));
    EXPECT_FALSE(lights.showsBackground());
    // Behind them, neither the spot nor what shines to one side is picked.
    std::vector<float> p(5);
    lights.pickProbabilities({{0.1, 0.2, -3}, {0, 0, 1}}, p);
    EXPECT_EQ(p[0], 0);
    EXPECT_EQ(p[1], 0);
    EXPECT_EQ(p[3], 0);
    EXPECT_GT(p[2], 0);
    EXPECT_GT(p[4], 0);
}

}  // namespace
}  // namespace woodcock::test
