// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/needs_cost.h"

#include <gtest/gtest.h>

#include "tests/support/expect_error.h"
#include "tests/support/expect_estimate.h"
#include "woodcock/proof/support/render_scene.h"

namespace woodcock::test {

using namespace proof;
using namespace render;
using namespace trade;

namespace {

constexpr const char* camera = R"(
[camera]
eye = [0.5, 0.5, 4]
look_at = [0.5, 0.5, 0.5]
fov = 20
)";
constexpr const char* fog = R"(
[[volume]]
box = { min = [0, 0, 0], max = [1, 1, 1] }
sigma_a = 0.5
sigma_s = 2
g = 0.3
)";
constexpr const char* haze = R"(
[[volume]]
box = { min = [0, 0, 0], max = [1, 1, 1] }
sigma_a = 1.5
)";
constexpr const char* environment = R"(
[[light]]
type = "environment"
)";
constexpr const char* sun = R"(
[[light]]
type = "sun"
direction = [0, -1, -0.3]
)";
constexpr const char* farLight = R"(
[[light]]
type = "point"
position = [0, 30, 0]
intensity = 1000
)";

/// Draws the scene with the need pretended and without: are they the same to the last bit?
bool expectSamePicture(const std::string& text, Need need, double largestError = 0.005) {
    const Scene scene = sceneFrom(text + camera), forced = forceNeed(scene, need);
    EXPECT_FALSE(has(findNeeds(scene), need));
    EXPECT_TRUE(has(findNeeds(forced), need));
    const Picture picture{.width = 12, .height = 12, .samples = 64};
    const auto mean = [&](const Scene& s, std::uint64_t seed) {
        Picture p = picture;
        p.seed = seed;
        return meanOverSeeds(s, p, 16);
    };
    expectAgree(mean(forced, 100), mean(scene, 200), largestError);
    return sameBits(renderScene(scene, picture).film, renderScene(forced, picture).film);
}

const std::string foggy = std::string(fog) + environment + sun;

TEST(NeedsCost, PretendedNeedsDrawTheSamePicture) {
    // Of three channels that agree the sums are rounded otherwise: no bits to compare.
    expectSamePicture(foggy, Need::Chromatic);
    EXPECT_TRUE(expectSamePicture(foggy, Need::Emission));
    expectSamePicture(foggy, Need::LocalLights);
    EXPECT_TRUE(expectSamePicture(foggy, Need::Surfaces));
    EXPECT_TRUE(expectSamePicture(std::string(fog) + environment, Need::LightSampling));
    expectSamePicture(std::string(haze) + environment, Need::Scattering);
}

TEST(NeedsCost, LocalLightsFarAwayMayBeSampledAsNearOnes) {
    expectSamePicture(std::string(fog) + farLight, Need::LocalLights);
}

TEST(NeedsCost, WhatIsNeededIsNotCompared) {
    const Scene scene = sceneFrom(foggy + camera);
    RenderSettings settings;
    settings.width = settings.height = 16;
    std::vector<NeedCost> costs;
    for (double budget = 10; costs.empty(); budget *= 4) {
        try {
            costs = needsCost(scene, settings, {.budget = budget, .precision = 0.2});
        } catch (const Error&) {
            if (budget > 600) throw;  // or the machine is only busy
        }
    }
    ASSERT_EQ(costs.size(), needNames.size());
    for (const NeedCost& cost : costs) {
        SCOPED_TRACE(needNames[static_cast<std::size_t>(cost.need)]);
        EXPECT_EQ(cost.needed, has(findNeeds(scene), cost.need));
        EXPECT_EQ(cost.pairs == 0, cost.needed);
        if (cost.needed) continue;
        EXPECT_GT(cost.with.value, 0);
        EXPECT_GT(cost.without.value, 0);
        EXPECT_GT(cost.ratio.value, 0);
        EXPECT_LE(std::abs(cost.difference.value), 4 * cost.difference.se + 1e-5);
    }
    const NeedCost& surfaces = costs[static_cast<std::size_t>(Need::Surfaces)];
    EXPECT_TRUE(surfaces.sameBits);
    EXPECT_EQ(surfaces.variance.value, 1);
}

TEST(NeedsCost, BudgetsThatAreTooSmallAreRefused) {
    const Scene scene = sceneFrom(foggy + camera);
    expectError(ErrorKind::Usage, "too small", [&] { needsCost(scene, {}, {.budget = 1e-3}); });
}

}  // namespace
}  // namespace woodcock::test
