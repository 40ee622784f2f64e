// SPDX-License-Identifier: Apache-2.0
// The same scenes as other renderers have drawn them.
#include <gtest/gtest.h>

#include "tests/support/brute_force.h"
#include "tests/support/expect_estimate.h"
#include "tests/support/paths.h"
#include "tests/support/peer_scene.h"
#include "woodcock/proof/support/read_back.h"
#include "woodcock/proof/support/render_scene.h"

namespace woodcock::test {

using namespace image;
using namespace light;
using namespace medium;
using namespace oracle;
using namespace proof;
using namespace render;

namespace {

constexpr int size = 160, block = 8, blocks = size / block;

/// Two pictures that differ in their noise only.
struct Pair {
    std::function<double(int x, int y, int channel)> a, b;
    std::function<bool(int x, int y)> covered;  ///< does the volume stand there? Of ours only
};

Pair peer(const std::string& name) {
    const auto read = [&](const char* seed) {
        const auto image = std::make_shared<ReadBack>(
            readBack(sharedDir() / "images" / (name + "_" + seed + ".exr")));
        return [image](int x, int y, int c) {
            return double{image->at(x, y, std::array{"R", "G", "B"}[static_cast<std::size_t>(c)])};
        };
    };
    return {read("1"), read("2"), {}};
}

Pair ours(const std::string& scene, int samples) {
    const Scene built = peerScene(scene);
    const auto draw = [&](std::uint64_t seed) {
        return std::make_shared<Film>(renderScene(built, {size, size, samples, seed}).film);
    };
    const auto radianceOf = [](const std::shared_ptr<Film>& film) {
        return [film](int x, int y, int c) { return double{film->radiance(x, y)[c]}; };
    };
    const auto a = draw(1), b = draw(2);
    return {radianceOf(a), radianceOf(b),
            [a, b](int x, int y) { return a->alpha(x, y) != 0 || b->alpha(x, y) != 0; }};
}

/// The mean over pixels [x0, x1) x [y0, y1) of both pictures; their difference tells the error.
Estimate meanOver(const Pair& pair, int channel, int x0, int y0, int x1, int y1) {
    double sum = 0, squares = 0;
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            const double a = pair.a(x, y, channel), b = pair.b(x, y, channel);
            sum += (a + b) / 2, squares += (a - b) * (a - b) / 4;
        }
    const double pixels = (x1 - x0) * (y1 - y0);
    return {sum / pixels, std::sqrt(squares) / pixels};
}
Estimate blockMean(const Pair& pair, int channel, int i) {
    const int x = i % blocks * block, y = i / blocks * block;
    return meanOver(pair, channel, x, y, x + block, y + block);
}

/// Pixels of a block that see the volume.
int coverage(const Pair& mine, int i) {
    int count = 0;
    for (int y = i / blocks * block; y < (i / blocks + 1) * block; ++y)
        for (int x = i % blocks * block; x < (i % blocks + 1) * block; ++x)
            count += mine.covered(x, y);
    return count;
}

/// Block by block within the noise of both, and the mean over the volume's blocks as well.
void expectSamePicture(const Pair& mine, const Pair& theirs, int channel, double largestError,
                       Rgb environment = Rgb(0.5f)) {
    SCOPED_TRACE(testing::Message() << "channel " << channel);
    Moments squares;
    Estimate a, b;
    double worst = 0;
    for (int i = 0; i < blocks * blocks; ++i) {
        const Estimate m = blockMean(mine, channel, i), t = blockMean(theirs, channel, i);
        const int covered = coverage(mine, i);
        if (covered == 0) {
            EXPECT_NEAR(m.mean, environment[channel], 1e-9) << "block " << i;
        }
        // A few pixels are too few to know their own noise.
        if (covered <= block * block / 2) continue;
        const double rounding = 1e-6;  // of environment, in blocks that the volume hardly touches
        const double z = (m.mean - t.mean) / std::hypot(m.error, t.error, rounding);
        squares.add(z * z), worst = std::max(worst, std::abs(z));
        a.mean += m.mean, a.error = std::hypot(a.error, m.error);
        b.mean += t.mean, b.error = std::hypot(b.error, t.error);
    }
    ASSERT_GT(squares.count(), 90u);
    const Estimate ratio{a.mean / b.mean, std::hypot(a.error / a.mean, b.error / b.mean)};
    expectAgrees(ratio, 1, largestError);
    // Squares of normal deviates: mean 1, variance 2.
    EXPECT_NEAR(squares.mean(), 1, 4 * std::sqrt(2 / static_cast<double>(squares.count())));
    EXPECT_LT(worst, 5);
}

class Peers : public testing::Test {
protected:
    void SetUp() override {
        if (!std::filesystem::exists(sharedDir() / "images"))
            GTEST_SKIP() << "no " << sharedDir() / "images";
    }
};

TEST_F(Peers, Thin) {
    const Pair mine = ours("thin", 128);
    for (const char* other : {"thin_mitsuba", "thin_cycles"}) {
        SCOPED_TRACE(other);
        expectSamePicture(mine, peer(other), 1, 1e-3);
    }
}

TEST_F(Peers, Cloud) { expectSamePicture(ours("cloud", 16), peer("cloud_pbrt"), 1, 4.5e-3); }

/// Cycles is some 0.2 % brighter than the same channels in other renderers, here and in pbrt, which
/// this much noise does not resolve.
TEST_F(Peers, Chromatic) {
    const Pair mine = ours("chromatic", 6), theirs = peer("chromatic_cycles");
    for (int c = 0; c < 3; ++c) expectSamePicture(mine, theirs, c, 3e-3);
}

/// Where volumes with different phase functions overlap, Cycles weights their mixture with one
/// number per volume, sigma_s averaged over the channels. That is exact in the channel where both
/// volumes have the same share of their average (green), and off in the others.
TEST_F(Peers, OverlapInGreen) {
    expectSamePicture(ours("overlap", 64), peer("overlap_cycles"), 1, 1.5e-3);
}

/// Smoke that glows as a black body does. Cycles' colours of black bodies are a fit, whose error in
/// blue, 0.06 %, more samples resolve.
TEST_F(Peers, Fire) {
    const Pair mine = ours("fire", 6), theirs = peer("fire_cycles");
    for (int c = 0; c < 3; ++c) expectSamePicture(mine, theirs, c, 1e-3, {0.04f, 0.05f, 0.07f});
}

TEST_F(Peers, OverlapInRedAndBlueByBruteForce) {
    const VdbValues density(sharedDir() / "assets" / "teapot_cloud.vdb", "density");
    const Scene scene = peerScene("overlap");
    const Pair mine = ours("overlap", 64), cycles = peer("overlap_cycles");
    constexpr int x0 = 80, y0 = 48, x1 = 128, y1 = 112;
    for (const int c : {0, 2}) {
        SCOPED_TRACE(testing::Message() << "channel " << c);
        BruteScene physics{
            {}, std::get<Sun>(scene.lights.lights()[0]).towards(), 3, 0.5, scene.camera};
        for (const MediumPart& part : scene.medium.parts) {
            const double scattering = part.scattering()[c];
            physics.volumes.push_back({&density, part.description().worldFromIndex,
                                       part.absorption()[c], scattering, part.phase().meanCosine(),
                                       scattering});
        }
        BruteScene averaged = physics;
        for (std::size_t i = 0; i < averaged.volumes.size(); ++i)
            averaged.volumes[i].phaseWeight = scene.medium.parts[i].scattering().mean();
        const int samples = 64;
        const Estimate right = bruteRadiance(physics, x0, y0, x1, y1, samples);
        const Estimate theirs = bruteRadiance(averaged, x0, y0, x1, y1, samples);
        expectAgree(meanOver(mine, c, x0, y0, x1, y1), right, 4e-3);
        expectAgree(meanOver(cycles, c, x0, y0, x1, y1), theirs, 4e-3);
        // They can be told apart.
        if (c == 0) {
            EXPECT_GT(theirs.mean - right.mean, 4 * std::hypot(theirs.error, right.error));
        }
    }
}

}  // namespace
}  // namespace woodcock::test
