// SPDX-License-Identifier: Apache-2.0
// Skies, from the scene file to the built lights.
#include "woodcock/scene/sky.h"

#include <gtest/gtest.h>

#include "tests/scene/built_scene.h"
#include "tests/support/scene_mistake.h"
#include "woodcock/light/sky_model.h"

namespace woodcock::test {

using namespace light;
using namespace scene;

namespace {

const std::string box = "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nsigma_s = 1\n";
const std::string heading = "[[light]]\ntype = \"sky\"\n";

std::string mistake(const std::string& lines) { return mistakeIn(box + heading + lines); }

SkyDescription described(const std::string& lines) {
    const SceneDescription scene = parseSceneText(box + heading + lines, "scene.toml", ".", {});
    return std::get<SkyDescription>(scene.lights.at(0).light);
}

/// The sky's lights, before that of buildLit().
std::vector<Light> built(const std::string& lines) {
    std::vector<Light> lights = buildLit(box + heading + lines).scene.lights.lights();
    lights.pop_back();
    return lights;
}

void expectNear(Rgb a, Rgb b, double relative) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], relative * double{b.maximum()}) << c;
}

const std::string paris =
    "latitude = 48.8566\nlongitude = 2.3522\ndate = 2026-06-21\ntime = 14:30:00\nutc_offset = 2\n";

TEST(Sky, IsTheModelsRadianceAndItsSun) {
    const SkyModel model({30, 4, {0.3f, 0.2f, 0.1f}});
    const std::vector<Light> lights = built(
        "elevation = 30\nazimuth = 90\nturbidity = 4\nground_albedo = [0.3, 0.2, 0.1]\n"
        "strength = 0.5\nsun_strength = 3\n");
    ASSERT_EQ(lights.size(), 2u);
    // East is towards +x.
    const Vec3d east = normalize(Vec3d{std::cos(pi / 6), 0.5, 0});
    expectNear(lights[0].distantRadiance(east), model.radiance(model.towardsSun()) * 0.5f, 5e-3);
    expectNear(lights[0].distantRadiance({0, 1, 0}), model.radiance({0, 1, 0}) * 0.5f, 5e-3);
    expectNear(lights[0].distantRadiance({0, -1, 0}),
               groundRadiance(model, {0.3f, 0.2f, 0.1f}, 3) * 0.5f, 1e-5);
    const auto& sun = std::get<Sun>(lights[1]);
    EXPECT_NEAR(length(sun.towards() - east), 0, 1e-12);
    expectNear(sun.irradiance(), model.sunIrradiance() * 1.5f, 1e-6);
    EXPECT_TRUE(sun.visible());
    // As a disc of 0.53 degrees.
    const double half = 0.265 * pi / 180;
    EXPECT_GT(sun.radiance(normalize(east + Vec3d{0, 0, 0.99 * half})).minimum(), 0);
    EXPECT_EQ(sun.radiance(normalize(east + Vec3d{0, 0, 1.01 * half})), Rgb(0.0f));
}

TEST(Sky, StandsUprightWhereZIsUp) {
    const std::vector<Light> lights = built("elevation = 20\nazimuth = 300\nup = \"z\"\n");
    const double e = 20 * pi / 180, a = 300 * pi / 180;
    const Vec3d sun{std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e)};
    EXPECT_NEAR(length(std::get<Sun>(lights.at(1)).towards() - sun), 0, 1e-12);
    const Vec3d across{-sun.x, -sun.y, sun.z};
    EXPECT_GT(lights[0].distantRadiance(sun).minimum(),
              2 * lights[0].distantRadiance(across).maximum());
    const SkyModel model({20, 3, Rgb(0.2f)});
    expectNear(lights[0].distantRadiance({0, 0, 1}), model.radiance({0, 1, 0}) * 0.03f, 5e-3);
}

TEST(Sky, MayLackItsSunOrItsGround) {
    const std::vector<Light> alone = built("elevation = 30\nsun = false\n");
    ASSERT_EQ(alone.size(), 1u);
    const SkyModel model({30, 3, Rgb(0.2f)});
    expectNear(alone[0].distantRadiance({0, -1, 0}), groundRadiance(model, Rgb(0.2f), 0) * 0.03f,
               1e-5);
    const std::vector<Light> floating = built("elevation = 30\nground = false\n");
    EXPECT_EQ(floating.at(0).distantRadiance({0, -1, 0}), Rgb(0.0f));
    const std::vector<Light> sharp = built("elevation = 30\nsun_size = 0\n");
    EXPECT_TRUE(std::get<Sun>(sharp.at(1)).delta());
    const std::vector<Light> hidden = built("elevation = 30\nvisible = false\n");
    EXPECT_FALSE(hidden.at(0).traits().visible);
    EXPECT_FALSE(hidden.at(1).traits().visible);
    EXPECT_EQ(built("elevation = 30\nsun_strength = 0\n").size(), 1u);
}

TEST(Sky, FollowsFromAPlaceAndATime) {
    const SkyDescription sky = described(paris);
    EXPECT_NEAR(sky.place.elevation, 63.528, 0.02);
    EXPECT_NEAR(sky.place.azimuth, 199.631, 0.02);
    for (const char* time : {"time = \"14:30\"", "time = \"14:30:00\""}) {
        std::string said = paris;
        said.replace(said.find("time = 14:30:00"), 15, time);
        said.replace(said.find("2026-06-21"), 10, "\"2026-06-21\"");
        EXPECT_EQ(described(said), sky) << time;
    }
}

TEST(Sky, IsRefusedWithOneClearError) {
    EXPECT_EQ(mistake(""),
              "scene.toml:4:1: light[0] is a sky that does not say where its sun stands; give "
              "elevation = 40, azimuth = 120, or latitude, longitude, date, time and utc_offset");
    EXPECT_EQ(mistake("elevation = -3\n"),
              "scene.toml:6:13: light[0].elevation is -3; it must lie between 0 and 90");
    EXPECT_EQ(mistake("elevation = 30\nturbidity = 11\n"),
              "scene.toml:7:13: light[0].turbidity is 11; it must lie between 1 and 10");
    EXPECT_EQ(mistake("elevation = 30\nground_albedo = 1.2\n"),
              "scene.toml:7:17: light[0].ground_albedo is 1.2; it must lie between 0 and 1");
    EXPECT_EQ(mistake("elevation = 30\n" + paris),
              "scene.toml:7:12: light[0].latitude cannot be used together with elevation; give one "
              "of them: both say where the sun stands");
    EXPECT_EQ(mistake("latitude = 48\nlongitude = 2\ndate = 2026-06-21\ntime = 14:30:00\n"),
              "scene.toml:4:1: light[0] has no utc_offset; where the sun stands follows from "
              "latitude, longitude, date, time, utc_offset");
    EXPECT_EQ(mistake("latitude = 48\nlongitude = 2\ndate = \"2026-02-30\"\n"),
              "scene.toml:8:8: light[0].date is '2026-02-30', which the calendar does not have; "
              "give one such as 2026-06-21");
    EXPECT_EQ(mistake("date = 2500-01-01\n"),
              "scene.toml:6:8: light[0].date is 2500-01-01; the sun's place is known from 1800 to "
              "2200");
    EXPECT_EQ(mistake("date = 12\n"),
              "scene.toml:6:8: light[0].date is an integer; expected a date, such as 2026-06-21");
    EXPECT_EQ(mistake("time = \"half past two\"\n"),
              "scene.toml:6:8: light[0].time is 'half past two', which is no time of day; give one "
              "such as 14:30:00 or \"14:30\"");
    EXPECT_EQ(mistake("elevation = 30\nsun = false\nsun_size = 1\n"),
              "scene.toml:8:12: light[0].sun_size is of the sun, and sun = false leaves it out");
    // TOML itself knows the calendar.
    EXPECT_NE(mistake("date = 2026-02-30\n").find("scene.toml:6:"), std::string::npos);
}

TEST(Sky, SaysWhenTheSunRises) {
    // Almanacs have the upper limb rise in Greenwich at 08:04, the centre follows soon.
    const std::string said = mistake(
        "latitude = 51.4779\nlongitude = 0\ndate = 2026-12-21\ntime = 03:00:00\nutc_offset = 0\n");
    EXPECT_EQ(said.substr(0, said.rfind("at ")),
              "scene.toml:9:8: light[0].time has the sun 45.3 degrees below the horizon, at "
              "2026-12-21 03:00; it rises next ");
    EXPECT_EQ(said.substr(said.size() - 16, 15), "2026-12-21 08:0");
}

}  // namespace
}  // namespace woodcock::test
