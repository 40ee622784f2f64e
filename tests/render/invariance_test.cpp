// SPDX-License-Identifier: Apache-2.0
// Different ways to say the same scene, and freedoms that no mean may show.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/expect_estimate.h"
#include "tests/support/paths.h"
#include "woodcock/base/random.h"
#include "woodcock/proof/support/render_scene.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace grid;
using namespace image;
using namespace medium;
using namespace proof;
using namespace render;

namespace {

/// A ragged ball of fog with holes, `factor` times as dense as it would be.
double fogValue(Vec3i v, double factor = 1) {
    const double r = length(v.as<double>() - Vec3d{15.5, 15.5, 15.5}) / 15.5;
    const double u = RandomStream(hashOf(11, v.x >> 1, v.y >> 1, v.z)).uniform();
    return r > 1 || u < 0.2 ? 0 : factor * (1 - r) * u;
}

GridSpec fog(double factor = 1, double voxel = 1.0 / 16) {
    GridSpec grid;
    grid.box = {{0, 0, 0}, {31, 31, 31}};
    grid.value = [factor](Vec3i v) { return fogValue(v, factor); };
    grid.worldFromIndex = Affine3d::translate({-voxel * 15.5, -voxel * 15.5, -voxel * 15.5}) *
                          Affine3d::scale({voxel, voxel, voxel});
    return grid;
}

constexpr const char* lights =
    "[[light]]\ntype = \"sun\"\ndirection = [-1, -2, -1]\nirradiance = [2, 2, 2]\n"
    "[[light]]\ntype = \"environment\"\nradiance = [0.3, 0.3, 0.3]\n";
constexpr const char* camera = "[camera]\neye = [0.5, 0.75, 3]\nlook_at = [0, 0, 0]\nfov = 30\n";
constexpr const char* grey = "scale = 20\nalbedo = 0.95\ng = 0.4\n";

class Invariance : public testing::Test {
protected:
    void SetUp() override { writeVdb(dir / "fog.vdb", {fog()}); }

    Scene fogScene(const std::string& volume, const std::string& rest) const {
        return sceneFrom("[[volume]]\nfile = \"fog.vdb\"\n" + volume + rest, dir.path());
    }
    Scene fogScene(const std::string& volume) const {
        return fogScene(volume, std::string(lights) + camera);
    }
    static RgbEstimate mean(const Scene& scene, std::uint64_t seed, int samples = 32) {
        return meanOverSeeds(scene, {24, 24, samples, seed}, 16);
    }

    const TempDir dir;
};

TEST_F(Invariance, LooseMajorantsChangeNoMean) {
    for (const char* volume : {grey, "sigma_a = [0.2, 3, 1]\nsigma_s = [20, 10, 2]\ng = 0.4\n"}) {
        const Scene scene = fogScene(volume);
        const RgbEstimate tight = mean(scene, 100);
        std::uint64_t seed = 200;
        const auto expectSame = [&](double scale, int smallestLog2) {
            const Scene loose = withParts(scene, [&](MediumPart::Description& d) {
                d.majorantScale = scale, d.majorantSmallestLog2 = smallestLog2;
            });
            expectAgree(mean(loose, seed += 100, 16), tight, 4e-3);
        };
        expectSame(2, 1);
        expectSame(8, 1);
        expectSame(1, 4);
        expectSame(1, 7);
    }
}

/// Each channel of a coloured medium is the grey medium of its own coefficients.
TEST_F(Invariance, ChannelsAreGreyMediaOfTheirOwn) {
    struct Channel {
        double absorption, scattering;
    };
    const std::array<Channel, 3> channels{{{0.5, 25}, {8, 12}, {20, 1}}};
    const RgbEstimate coloured =
        mean(fogScene("sigma_a = [0.5, 8, 20]\nsigma_s = [25, 12, 1]\ng = 0.4\n"), 100);
    for (std::size_t c = 0; c < 3; ++c) {
        SCOPED_TRACE(testing::Message() << "channel " << c);
        const Scene alone = fogScene(fmt::format("sigma_a = {}\nsigma_s = {}\ng = 0.4\n",
                                                 channels[c].absorption, channels[c].scattering));
        expectAgree(coloured[c], mean(alone, 200)[0], 4e-3);
    }
}

/// Dark media: paths end by Russian roulette in all channels before they leave.
TEST_F(Invariance, ChannelsOfADarkMediumToo) {
    const std::string dark =
        std::string(camera) + "[[light]]\ntype = \"environment\"\nradiance = 1\nvisible = false\n";
    const Scene coloured = fogScene("sigma_a = [90, 40, 2]\nsigma_s = [10, 60, 0.5]\n", dark);
    const RgbEstimate e = meanOverSeeds(coloured, {24, 24, 256, 100}, 16);
    const std::array<std::pair<double, double>, 3> channels{{{90, 10}, {40, 60}, {2, 0.5}}};
    for (std::size_t c = 0; c < 3; ++c) {
        SCOPED_TRACE(testing::Message() << "channel " << c);
        const Scene alone = fogScene(
            fmt::format("sigma_a = {}\nsigma_s = {}\n", channels[c].first, channels[c].second),
            dark);
        expectAgree(e[c], meanOverSeeds(alone, {24, 24, 192, 200}, 16)[0], 5e-3);
    }
}

TEST_F(Invariance, HalvesThatOverlapAreTheWhole) {
    writeVdb(dir / "half.vdb", {fog(0.5)});
    writeVdb(dir / "rest.vdb", {fog(0.5)});
    const std::string volume = "sigma_a = [0.2, 3, 1]\nsigma_s = [20, 10, 2]\ng = 0.4\n";
    const Scene whole = fogScene(volume);
    const Scene halves =
        sceneFrom("[[volume]]\nfile = \"half.vdb\"\n" + volume +
                      "[[volume]]\nfile = \"rest.vdb\"\n" + volume + lights + camera,
                  dir.path());
    expectAgree(mean(halves, 100), mean(whole, 200), 3e-3);
}

/// Absorption and scattering from grids of their own are two media in one place.
TEST_F(Invariance, GridsOfTheirOwnAreTheSameMedium) {
    GridSpec a = fog(), s = fog();
    a.name = "absorb", s.name = "scatter";
    s.type = VdbType::Vec3s;
    s.colour = [](Vec3i v) { return Vec3d{1, 0.5, 0.25} * fogValue(v); };
    writeVdb(dir / "two.vdb", {a, s});
    const Scene own = sceneFrom(std::string("[[volume]]\nfile = \"two.vdb\"\ng = 0.4\n"
                                            "sigma_a = { grid = \"absorb\", scale = 4 }\n"
                                            "sigma_s = { grid = \"scatter\", scale = 20 }\n") +
                                    lights + camera,
                                dir.path());
    const Scene one = fogScene("sigma_a = 4\nsigma_s = [20, 10, 5]\ng = 0.4\n");
    expectAgree(mean(own, 100), mean(one, 200), 4e-3);
}

TEST_F(Invariance, AlbedoGridsAreTheSameMedium) {
    GridSpec density = fog(), albedo = fog();
    albedo.name = "Cd", albedo.type = VdbType::Vec3s;
    albedo.box = {{-8, -8, -8}, {39, 39, 39}};  // beyond the density, so that ramps do not show
    albedo.colour = [](Vec3i) { return Vec3d{0.9, 0.5, 0.1}; };
    writeVdb(dir / "albedo.vdb", {density, albedo});
    const Scene own = sceneFrom(std::string("[[volume]]\nfile = \"albedo.vdb\"\ng = 0.4\n"
                                            "scale = 20\nalbedo_grid = \"Cd\"\n") +
                                    lights + camera,
                                dir.path());
    expectAgree(mean(own, 100),
                mean(fogScene("scale = 20\nalbedo = [0.9, 0.5, 0.1]\ng = 0.4\n"), 200), 4e-3);
}

/// All lengths times k and sigma divided by it, by powers of two, rounds nothing: the same picture,
/// bit for bit.
TEST_F(Invariance, Scale) {
    const Film film = renderScene(fogScene(grey), {24, 24, 16}).film;
    for (const double k : {0x1p20, 0x1p-30}) {
        const Scene scaled = fogScene(
            fmt::format(
                "scale = {:.17g}\nalbedo = 0.95\ng = 0.4\ntransform = {{ scale = {:.17g} }}\n",
                20 / k, k),
            fmt::format("{}[camera]\neye = [{:.17g}, {:.17g}, {:.17g}]\nlook_at = [0, 0, 0]\n"
                        "fov = 30\n",
                        lights, 0.5 * k, 0.75 * k, 3 * k));
        const Film other = renderScene(scaled, {24, 24, 16}).film;
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x) EXPECT_EQ(film.radiance(x, y), other.radiance(x, y));
    }
}

TEST_F(Invariance, FarFromTheOrigin) {
    const Scene here = fogScene(grey);
    for (const double far : {1e3, 1e7}) {
        const Scene there =
            fogScene(fmt::format("{}transform = {{ translate = [{:.17g}, {:.17g}, {:.17g}] }}\n",
                                 grey, far, -far, far),
                     fmt::format("{}[camera]\neye = [{:.17g}, {:.17g}, {:.17g}]\n"
                                 "look_at = [{:.17g}, {:.17g}, {:.17g}]\nfov = 30\n",
                                 lights, far + 0.5, 0.75 - far, far + 3, far, -far, far));
        expectAgree(mean(there, 100), mean(here, 200), 3e-3);
    }
}

/// Rotating the volume, the lights and the camera together.
TEST_F(Invariance, Orientation) {
    const Affine3d turn =
        Affine3d::rotate(2, 25) * Affine3d::rotate(0, 50) * Affine3d::rotate(1, 80);
    const auto text = [&](Vec3d v) {
        const Vec3d t = turn.vector(v);
        return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", t.x, t.y, t.z);
    };
    const Affine3d& m = turn;
    const std::string turned =
        fmt::format("matrix = [[{}, {}, {}, 0], [{}, {}, {}, 0], [{}, {}, {}, 0], [0, 0, 0, 1]]\n",
                    m.column[0].x, m.column[1].x, m.column[2].x, m.column[0].y, m.column[1].y,
                    m.column[2].y, m.column[0].z, m.column[1].z, m.column[2].z);
    const std::string rest = fmt::format(
        "[[light]]\ntype = \"sun\"\ndirection = {}\nirradiance = 2\n"
        "[[light]]\ntype = \"environment\"\nradiance = 0.3\n"
        "[camera]\neye = {}\nlook_at = [0, 0, 0]\nup = {}\nfov = 30\n",
        text({-1, -2, -1}), text({0.5, 0.75, 3}), text({0, 1, 0}));
    expectAgree(mean(fogScene(grey + turned, rest), 100), mean(fogScene(grey), 200), 3e-3);
}

TEST_F(Invariance, CameraInsideTheFog) {
    writeVdb(dir / "half.vdb", {fog(0.5)});
    const std::string inside =
        std::string(lights) + "[camera]\neye = [0.1, 0.2, -0.1]\nlook_at = [1, 0, 1]\nfov = 100\n";
    const std::string half = "[[volume]]\nfile = \"half.vdb\"\n" + std::string(grey);
    expectAgree(mean(sceneFrom(half + half + inside, dir.path()), 100),
                mean(fogScene(grey, inside), 200), 3e-3);
}

TEST_F(Invariance, HalfStorageChangesLittle) {
    // Values that half cannot hold: at most 2^-11 off, each one way or the other.
    const Scene whole = fogScene(std::string(grey) + "storage = \"float\"\n");
    const Scene halved = fogScene(std::string(grey) + "storage = \"half\"\n");
    ASSERT_EQ(whole.medium.parts[0].field()->storage(), Storage::Float);
    ASSERT_EQ(halved.medium.parts[0].field()->storage(), Storage::Half);
    Moments ratio;  // of pairs with the same random numbers
    for (std::uint64_t seed = 0; seed < 32; ++seed)
        ratio.add(meanRadiance(renderScene(halved, {24, 24, 32, seed}).film, 0) /
                  meanRadiance(renderScene(whole, {24, 24, 32, seed}).film, 0));
    EXPECT_LT(std::abs(ratio.mean() - 1) + 4 * ratio.standardError(), 1e-3);
}

/// Orders of scattering add up: each bound shows more light, and a high one all of it.
TEST_F(Invariance, BoundsOnScattering) {
    const Scene scene = fogScene("scale = 20\ng = 0.4\n");
    const auto bounded = [&](std::optional<int> most) {
        return meanOverSeeds(scene, {24, 24, 32, 100, most}, 16)[0];
    };
    const Estimate all = bounded({});
    Estimate before{0, 0};
    for (const int most : {0, 1, 2, 8}) {
        const Estimate now = bounded(most);
        EXPECT_GT(now.mean - before.mean, 4 * std::hypot(now.error, before.error)) << most;
        before = now;
    }
    EXPECT_GT(all.mean - before.mean, 4 * std::hypot(all.error, before.error));
    expectAgree(bounded(1000), all, 4e-3);
    // Nothing scattered: the environment behind the fog alone.
    const Scene absorbs = fogScene("scale = 20\nalbedo = 0\n");
    expectAgree(bounded(0), meanOverSeeds(absorbs, {24, 24, 32, 300}, 16)[0], 4e-3);
}

}  // namespace
}  // namespace woodcock::test
