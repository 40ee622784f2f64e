// SPDX-License-Identifier: Apache-2.0
#include "woodcock/denoise/denoiser.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/environment_variable.h"
#include "tests/support/expect_error.h"
#include "tests/support/paths.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/denoise/library_search.h"

namespace woodcock::test {

using namespace denoise;
using namespace image;

namespace {

namespace fs = std::filesystem;

/// A film of 5 x 3 pixels of which 3 x 2 are drawn, all numbers of which are sums of a few powers
/// of two, so that what the fake library computes is exact.
Film film() {
    Film film(5, 3, {1, 1, 4, 3}, {.surfaces = false, .features = true});
    for (int y = 1; y < 3; ++y)
        for (int x = 1; x < 4; ++x) {
            const auto v = static_cast<float>(x + 4 * y);
            film.add(x, y, FilmSample{Rgb(v, 2 * v, 3 * v), 0.5f});
            DepthSample depth;
            depth.weight = 1;
            depth.weightedAlbedo = Rgb(v / 64, v / 32, 0.5f);
            depth.weightedNormal = {-v / 32, 0.25f, v / 64};
            film.add(x, y, depth);
        }
    return film;
}

/// What the environment says of where the library is, in a test: nothing but `named`.
class Somewhere {
public:
    explicit Somewhere(const std::string& named)
        : named_(libraryVariable, named.empty() ? std::nullopt : std::optional(named)),
          virtualEnv_("VIRTUAL_ENV", {}),
          conda_("CONDA_PREFIX", {}),
          path_("PATH", {}),
          home_("HOME", {}) {}

private:
    EnvironmentVariable named_, virtualEnv_, conda_, path_, home_;
};

/// A folder with a library in it, as pyoidn has it in an environment of Python.
void installFake(const fs::path& folder) {
    fs::create_directories(folder);
    fs::copy_file(fakeOidn(), folder / libraryName);
}

TEST(Denoiser, GivesColourWithFilteredFeatures) {
    const Somewhere fake(fakeOidn());
    const Denoiser denoiser = Denoiser::load();
    EXPECT_EQ(denoiser.name(), "Open Image Denoise 2.7.1");
    EXPECT_EQ(denoiser.file(), fakeOidn());
    const TempDir dir;
    const EnvironmentVariable log("FAKE_OIDN_LOG", (dir / "log").string());
    const Film noisy = film();
    const DenoisedPicture picture = denoiser.denoise(noisy, 3);
    EXPECT_EQ(picture.denoiser, denoiser.name());
    EXPECT_EQ(picture.crop, noisy.crop());
    ASSERT_EQ(picture.colour.size(), 18u);
    for (int y = 1; y < 3; ++y)
        for (int x = 1; x < 4; ++x) {
            const Rgb radiance = noisy.radiance(x, y), albedo = noisy.albedo(x, y);
            const Vec3f normal = noisy.normal(x, y);
            for (int c = 0; c < 3; ++c)
                EXPECT_EQ(picture.radiance(x, y)[c], radiance[c] + albedo[c] / 2 + normal[c] / 4);
        }
    EXPECT_EQ(readText(dir / "log"),
              "albedo 3x2 output 3x2 threads 3 affinity 0\n"
              "normal 3x2 output 3x2 threads 3 affinity 0\n"
              "albedo 3x2 color 3x2 normal 3x2 output 3x2 cleanAux hdr threads 3 affinity 0\n");
}

TEST(Denoiser, LightOfAColourThatCannotBeIsNone) {
    const Somewhere fake(fakeOidn());
    Film film(1, 1, {0, 0, 1, 1}, {.surfaces = false, .features = true});
    film.add(0, 0, FilmSample{Rgb(1, 0.5f, -0.25f), 1});
    const DenoisedPicture picture = Denoiser::load().denoise(film);
    EXPECT_EQ(picture.radiance(0, 0), Rgb(1, 0.5f, 0));
}

TEST(Denoiser, WhatGoesWrongIsSaid) {
    const Somewhere fake(fakeOidn());
    const auto loaded = [](const char* wrong) {
        const EnvironmentVariable fails("FAKE_OIDN", wrong);
        return messageOf(ErrorKind::Usage, [] { Denoiser::load(); });
    };
    const std::string file = "'" + fakeOidn().string() + "'";
    EXPECT_EQ(loaded("device"), file +
                                    " does not work: Open Image Denoise has no device "
                                    "for this processor: no processor is good enough");
    EXPECT_EQ(loaded("version"), file + " is Open Image Denoise 3.7.1, and version 2 is needed");
    const Denoiser denoiser = Denoiser::load();
    const auto denoised = [&](const char* wrong) {
        const EnvironmentVariable fails("FAKE_OIDN", wrong);
        return messageOf(ErrorKind::Failure, [&] { denoiser.denoise(film()); });
    };
    EXPECT_EQ(denoised("filter"), "Open Image Denoise fails: the weights are lost");
    EXPECT_EQ(denoised("nan"),
              "Open Image Denoise fails: its picture holds numbers that are not finite");
}

TEST(Denoiser, WhatIsNamedCountsAlone) {
    const TempDir dir;
    const auto said = [](const fs::path& named) {
        const Somewhere only(named);
        return messageOf(ErrorKind::Usage, [] { Denoiser::load(); });
    };
    EXPECT_EQ(said(dir / "none"),
              "WOODCOCK_OIDN names '" + (dir / "none").string() + "', which is not there");
    EXPECT_EQ(said(dir.path()), "WOODCOCK_OIDN names the folder '" + dir.path().string() +
                                    "', which holds no libOpenImageDenoise.so.2");
    writeWholeFile(dir / "text.so", "no library");
    EXPECT_NE(said(dir / "text.so").find("text.so' cannot be loaded: "), std::string::npos);
    EXPECT_NE(said("libm.so.6").find("not there"), std::string::npos) << "no name, but a file";
    {
        const Somewhere none(dir / "none");
        EXPECT_FALSE(Denoiser::find());
    }
    const Somewhere broken(dir / "text.so");
    expectError(ErrorKind::Usage, "cannot be loaded", [] { Denoiser::find(); });
}

TEST(Denoiser, AnotherLibraryIsNone) {
    // Any library that this program has loaded, but no Open Image Denoise.
    for (const char* folder : {"/lib/x86_64-linux-gnu", "/lib/aarch64-linux-gnu", "/lib64"})
        if (const fs::path other = fs::path(folder) / "libm.so.6"; fs::exists(other)) {
            const Somewhere named(other);
            EXPECT_EQ(messageOf(ErrorKind::Usage, [] { Denoiser::load(); }),
                      "'" + other.string() +
                          "' is not Open Image Denoise 2: it has no function oidnNewDevice");
            return;
        }
    GTEST_SKIP() << "no libm.so.6 where it is looked for";
}

TEST(Denoiser, AFolderMayHoldItAsPackagesDo) {
    for (const char* below : {"", "lib", "oidn/lib", "pyoidn/oidn/lib"}) {
        const TempDir dir;
        installFake(dir / below);
        const Somewhere named(dir.path());
        EXPECT_EQ(Denoiser::load().file(), dir / below / libraryName) << below;
    }
}

TEST(Denoiser, EnvironmentsOfPythonAreSearchedInTheirOrder) {
    const TempDir active, other;
    const std::string packages = "lib/python3.99/site-packages/pyoidn/oidn/lib";
    installFake(active / packages);
    installFake(other / "lib");
    fs::create_directories(other / "bin");
    writeWholeFile(other / "bin/python3", "");
    const Somewhere nowhere("");
    const EnvironmentVariable path("PATH", (other / "bin").string() + ":relative:/nowhere");
    {
        const EnvironmentVariable environment("VIRTUAL_ENV", active.path().string());
        const std::vector<fs::path> found = installedLibraries();
        ASSERT_GE(found.size(), 2u);
        EXPECT_EQ(found[0], active / packages / libraryName);
        EXPECT_EQ(found[1], other / "lib" / libraryName);
    }
    EXPECT_EQ(installedLibraries().at(0), other / "lib" / libraryName);
    EXPECT_EQ(prefixes(), (std::vector<fs::path>{other.path(), "/usr/local", "/usr"}));
}

/// With the real library: a test that runs where it is installed.
class RealDenoiser : public testing::Test {
protected:
    void SetUp() override {
        denoiser_ = Denoiser::find();
        if (!denoiser_)
            GTEST_SKIP() << "Open Image Denoise is not installed ('pip install pyoidn')";
    }

    /// A square of radiance 1 on 0.25, with noise as of so many samples of variance `variance`
    /// times the square of the radiance; albedo and normal tell the square.
    static Film noisy(int samples, double variance) {
        constexpr int size = 64;
        Film film(size, size, {0, 0, size, size}, {.surfaces = false, .features = true});
        std::mt19937 random(7);
        std::gamma_distribution<float> noise(static_cast<float>(1 / variance),
                                             static_cast<float>(variance));
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x)
                for (int s = 0; s < samples; ++s) {
                    film.add(x, y, FilmSample{Rgb(noise(random) * truth(x, y)), 1});
                    DepthSample depth;
                    depth.weight = 1;
                    depth.weightedAlbedo = Rgb(inside(x, y) ? 0.8f : 0.2f);
                    depth.weightedNormal = inside(x, y) ? Vec3f{0, 0, 1} : Vec3f{0, 1, 0};
                    film.add(x, y, depth);
                }
        return film;
    }
    static bool inside(int x, int y) { return x >= 16 && x < 48 && y >= 16 && y < 48; }
    static float truth(int x, int y) { return inside(x, y) ? 1.0f : 0.25f; }

    template <class Radiance>
    static double squaredError(const Radiance& radiance) {
        double sum = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x)
                for (int c = 0; c < 3; ++c)
                    sum += std::pow(double{radiance(x, y)[c]} - double{truth(x, y)}, 2);
        return sum / (64 * 64 * 3);
    }

    std::optional<Denoiser> denoiser_;
};

TEST_F(RealDenoiser, TakesNoiseAwayAndKeepsTheEdge) {
    const Film film = noisy(4, 1);
    const DenoisedPicture picture = denoiser_->denoise(film);
    const double before = squaredError([&](int x, int y) { return film.radiance(x, y); });
    const double after = squaredError([&](int x, int y) { return picture.radiance(x, y); });
    // A smoothing of 5 x 5 pixels would take at most 25 times; a blurred edge would bring more.
    EXPECT_LT(after, before / 25);
    EXPECT_EQ(picture.denoiser.rfind("Open Image Denoise 2.", 0), 0u) << picture.denoiser;
}

TEST_F(RealDenoiser, GivesTheSameBitsWithAnyNumberOfThreads) {
    const Film film = noisy(2, 1);
    EXPECT_EQ(denoiser_->denoise(film, 1).colour, denoiser_->denoise(film, 3).colour);
}

TEST_F(RealDenoiser, TakesAnyPicture) {
    Film black(1, 1, {0, 0, 1, 1}, {.surfaces = false, .features = true});
    EXPECT_EQ(denoiser_->denoise(black).radiance(0, 0), Rgb(0));
    Film bright(17, 3, {2, 0, 17, 3}, {.surfaces = false, .features = true});
    for (int y = 0; y < 3; ++y)
        for (int x = 2; x < 17; ++x) bright.add(x, y, FilmSample{Rgb(1e30f, 1, 1e-30f), 1});
    for (const float v : denoiser_->denoise(bright).colour) EXPECT_TRUE(std::isfinite(v));
}

}  // namespace
}  // namespace woodcock::test
