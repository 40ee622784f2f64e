// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/sky_model.h"

#include <gtest/gtest.h>

#include "woodcock/base/error.h"
#include "woodcock/base/random.h"
#include "woodcock/light/environment_map.h"

namespace woodcock::test {

using namespace light;

namespace {

constexpr double degree = pi / 180;

/// With the sun towards -z, at azimuth 0.
Vec3d towards(double zenith, double azimuth) {
    const double sine = std::sin(zenith * degree);
    return {sine * std::sin(azimuth * degree), std::cos(zenith * degree),
            -sine * std::cos(azimuth * degree)};
}

double kilolux(Rgb irradiance) {
    return 0.683 * (0.2126 * double{irradiance[0]} + 0.7152 * double{irradiance[1]} +
                    0.0722 * double{irradiance[2]});
}

// The emitter `sunsky` of Mitsuba 3.7.1 (scalar_rgb), without the sun, times 106.75026, by which
// it divides. Five digits.
TEST(SkyModel, AgreesWithMitsuba) {
    const struct {
        double turbidity;
        Rgb albedo;
        double elevation, zenith, azimuth;
        std::array<double, 3> radiance;
    } published[]{
        {1, Rgb(0.0f), 90, 10, 0, {1.9965, 5.1317, 9.6565}},
        {3, Rgb(0.2f), 45, 0, 0, {2.4143, 4.1849, 8.4824}},
        {2.5, Rgb(0.5f), 30, 60, 120, {3.8571, 7.0995, 12.421}},
        {6, {0.2f, 0.4f, 0.1f}, 20, 40, 20, {7.7501, 9.0918, 9.6606}},
        {2, Rgb(0.2f), 5, 85, 90, {6.1744, 6.6649, 4.4145}},
        {9.5, Rgb(1.0f), 10, 80, 3, {108.54, 69.124, 32.042}},
        {4, Rgb(0.0f), 60, 33, 7, {24.877, 27.04, 29.317}},
        {10, Rgb(0.3f), 0.5, 75, 170, {1.3432, 1.2044, 0.89667}},
    };
    for (const auto& p : published) {
        const SkyModel sky({p.elevation, p.turbidity, p.albedo});
        const Rgb l = sky.radiance(towards(p.zenith, p.azimuth));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(l[c] / p.radiance[static_cast<size_t>(c)], 1, 1e-4)
                << p.turbidity << " " << p.elevation << " " << c;
    }
}

TEST(SkyModel, IsDarkBelowTheHorizonAndBrightestTowardsTheSun) {
    const SkyModel sky({30, 3, Rgb(0.2f)});
    EXPECT_EQ(sky.radiance({0, -1e-9, -1}), Rgb(0.0f));
    EXPECT_GT(sky.radiance({0, 0, -1}).minimum(), 0);
    RandomStream random(1);
    for (int i = 0; i < 1000; ++i) {
        const Vec3d d = towards(60, 360 * random.uniform());  // as high as the sun
        EXPECT_LE(sky.radiance(d).maximum(), sky.radiance(sky.towardsSun()).maximum());
    }
}

TEST(SkyModel, KnowsItsIrradiance) {
    for (const double elevation : {0.0, 3.0, 40.0, 90.0}) {
        const SkyModel sky({elevation, 2.5, {0.1f, 0.3f, 0.8f}});
        double sum = 0;  // even in the cosine of the zenith angle
        constexpr int rows = 1000, columns = 400;
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x) {
                const double cosine = (y + 0.5) / rows;
                const double zenith = std::acos(cosine) / degree;
                sum += sky.radiance(towards(zenith, 360 * (x + 0.5) / columns))[1] * cosine;
            }
        sum *= 2 * pi / rows / columns;
        EXPECT_NEAR(sky.skyIrradiance()[1] / sum, 1, 5e-4) << elevation;
    }
}

TEST(SkyModel, ChangesSmoothlyWithWhatItIsMadeOf) {
    const auto at = [](double elevation, double turbidity, float albedo) {
        const SkyModel sky({elevation, turbidity, Rgb(albedo)});
        return std::array<Rgb, 4>{sky.radiance(towards(50, 70)), sky.radiance(towards(89, 30)),
                                  sky.sunIrradiance(), sky.skyIrradiance()};
    };
    const auto expectClose = [](const std::array<Rgb, 4>& a, const std::array<Rgb, 4>& b) {
        for (size_t i = 0; i < a.size(); ++i)
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(a[i][c], b[i][c], 1e-3 * a[i].maximum() + 1e-5) << i << " " << c;
    };
    RandomStream random(2);
    for (int i = 0; i < 50; ++i) {
        // Also across the tables' own entries.
        const double knot = 90 * std::pow((1 + std::floor(44 * random.uniform())) / 45, 3);
        const double elevation = 1 + 88 * random.uniform(), turbidity = 1 + 8.9 * random.uniform();
        const double whole = 2 + std::floor(8 * random.uniform());
        const auto albedo = static_cast<float>(random.uniform());
        const double step = 1e-5;
        expectClose(at(elevation, turbidity, albedo), at(elevation + step, turbidity, albedo));
        expectClose(at(knot * (1 - step), turbidity, albedo), at(knot, turbidity, albedo));
        expectClose(at(elevation, turbidity, albedo), at(elevation, turbidity + step, albedo));
        expectClose(at(elevation, whole - step, albedo), at(elevation, whole, albedo));
        expectClose(at(elevation, turbidity, albedo), at(elevation, turbidity, albedo + 1e-5f));
    }
}

// Bird and Riordan 1986 ("Simple Solar Spectral Model ..."), without aerosol, with 1.5 cm of water
// and 0.34 cm of ozone: the spectrum at 33 wavelengths, linear between them, by the same observer.
TEST(SkyModel, HasTheSunOfCleanAir) {
    const struct {
        double elevation;
        std::array<double, 3> irradiance;
    } clean[]{{90, {192.4, 168.4, 145.4}},
              {60, {189.6, 165.1, 140.2}},
              {30, {175.1, 148.1, 115.0}},
              {10, {127.2, 93.3, 49.2}}};
    // The model's air scatters a quarter more: that shows in the blue of a low sun.
    for (const auto& k : clean) {
        const Rgb sun = SkyModel({k.elevation, 1, Rgb(0.0f)}).sunIrradiance();
        for (int c = 0; c < 3; ++c) {
            const double ratio = sun[c] / k.irradiance[static_cast<size_t>(c)];
            EXPECT_LT(ratio, 1.12) << k.elevation << " " << c;
            EXPECT_GT(ratio, c < 2              ? 0.88
                             : k.elevation < 30 ? 0.65
                                                : 0.85)
                << k.elevation << " " << c;
        }
    }
}

// Direct normal illuminance, 133.8 klx exp(-a m T), a = 0.1 / (1 + 0.0045 m), with the luminous
// turbidity T of Kittler and Darula: 1 for air alone, 2 to 4 for clear skies, 6 for hazy ones.
TEST(SkyModel, HasASunAsBrightAsIsMeasured) {
    const auto measured = [](double elevation, double turbidity) {
        const double m = 1 / (std::sin(elevation * degree) +  // Kasten and Young 1989
                              0.50572 * std::pow(elevation + 6.07995, -1.6364));
        return 133.8 * std::exp(-0.1 / (1 + 0.0045 * m) * m * turbidity);
    };
    for (const double elevation : {90.0, 45.0, 30.0, 20.0, 10.0})
        for (const double turbidity : {1.0, 2.0, 3.0, 5.0, 8.0}) {
            const Rgb sun = SkyModel({elevation, turbidity, Rgb(0.2f)}).sunIrradiance();
            EXPECT_LT(kilolux(sun), measured(elevation, 1)) << elevation << " " << turbidity;
            EXPECT_GT(kilolux(sun), measured(elevation, 6)) << elevation << " " << turbidity;
        }
    // The reference spectrum ASTM G173 (air mass 1.5, optical depth of aerosols 0.084 at 500 nm):
    // 97.1 klx. A turbidity of 1.8 is that much haze at 550 nm.
    EXPECT_NEAR(kilolux(SkyModel({41.81, 1.8, Rgb(0.2f)}).sunIrradiance()) / 97.1, 1, 0.1);
}

// Haze scatters and hardly absorbs, and mostly forwards: what the sun loses, the sky gains.
TEST(SkyModel, KeepsTheLightThatHazeTakesFromTheSun) {
    for (const double elevation : {90.0, 60.0, 30.0, 10.0}) {
        const auto level = [&](double turbidity) {
            const SkyModel sky({elevation, turbidity, Rgb(0.0f)});
            const auto sine = static_cast<float>(std::sin(elevation * degree));
            return kilolux(sky.skyIrradiance() + sky.sunIrradiance() * sine);
        };
        for (const double turbidity : {2.0, 3.0, 4.0, 5.0})
            EXPECT_NEAR(level(turbidity) / level(1), 1, 0.04) << elevation << " " << turbidity;
    }
}

TEST(SkyModel, GetsRedderAsTheSunSets) {
    double before = 0;
    for (const double elevation : {90.0, 45.0, 20.0, 10.0, 5.0, 2.0}) {
        const Rgb sun = SkyModel({elevation, 2.5, Rgb(0.2f)}).sunIrradiance();
        const double red = double{sun[0]} / double{sun[1]};
        EXPECT_GT(red, before);
        EXPECT_GE(sun.minimum(), 0);
        before = red;
    }
    const Rgb zenith = SkyModel({30, 2.5, Rgb(0.2f)}).radiance({0, 1, 0});
    EXPECT_GT(zenith[2], 2 * zenith[0]);
}

TEST(SkyModel, IsDrawnAsAnImage) {
    const double elevations[]{3, 30, 75};
    for (const double elevation : elevations) {
        const SkyModel sky({elevation, 3, Rgb(0.3f)});
        const Rgb ground = groundRadiance(sky, Rgb(0.3f), 1);
        const EnvironmentMap map(skyImageWidth, skyImageWidth / 2,
                                 skyImage(sky, ground, skyImageWidth));
        EXPECT_EQ(map.radiance({0, -1, 0}), ground);
        RandomStream random(3);
        double squares = 0, worst = 0;
        const int n = 20000;
        for (int i = 0; i < n; ++i) {
            const double up = 0.005 + 0.995 * random.uniform();
            const double angle = std::acos(up) / degree;
            const Vec3d d = towards(angle, 360 * random.uniform());
            const double error = double{map.radiance(d)[1]} / double{sky.radiance(d)[1]} - 1;
            squares += error * error, worst = std::max(worst, std::abs(error));
        }
        EXPECT_LT(std::sqrt(squares / n), 1e-3) << elevation;
        EXPECT_LT(worst, 0.02) << elevation;
    }
}

TEST(SkyModel, LightsTheGround) {
    const SkyModel sky({30, 3, Rgb(0.5f)});
    const Rgb with = groundRadiance(sky, Rgb(0.5f), 1), without = groundRadiance(sky, Rgb(0.5f), 0);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(without[c] * pi / (0.5 * double{sky.skyIrradiance()[c]}), 1, 1e-6);
        EXPECT_NEAR((with[c] - without[c]) * pi / (0.25 * double{sky.sunIrradiance()[c]}), 1, 1e-5);
    }
}

TEST(SkyModel, RefusesWhatItDoesNotKnow) {
    const auto message = [](const SkyModel::Conditions& conditions) -> std::string {
        try {
            SkyModel sky(conditions);
        } catch (const Error& e) {
            return e.what();
        }
        return "";
    };
    EXPECT_EQ(message({-0.1, 3, Rgb(0.2f)}),
              "the sun's elevation is -0.1 degrees; the sky model holds from 0 to 90");
    EXPECT_EQ(message({std::nan(""), 3, Rgb(0.2f)}),
              "the sun's elevation is nan degrees; the sky model holds from 0 to 90");
    EXPECT_EQ(message({30, 0.5, Rgb(0.2f)}),
              "the turbidity is 0.5; the sky model holds from 1 to 10");
    EXPECT_EQ(message({30, 10.5, Rgb(0.2f)}),
              "the turbidity is 10.5; the sky model holds from 1 to 10");
    EXPECT_EQ(message({30, 3, {0.2f, 1.5f, 0}}),
              "the ground's albedo is [0.2, 1.5, 0]; it must lie between 0 and 1");
    for (const double elevation : {0.0, 90.0})
        for (const double turbidity : {1.0, 10.0})
            for (const float albedo : {0.0f, 1.0f}) {
                const SkyModel sky({elevation, turbidity, Rgb(albedo)});
                EXPECT_TRUE(sky.radiance(sky.towardsSun()).isFinite());
                EXPECT_TRUE(sky.sunIrradiance().isFinite());
            }
}

}  // namespace
}  // namespace woodcock::test
