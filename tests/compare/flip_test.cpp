// SPDX-License-Identifier: Apache-2.0
#include "woodcock/compare/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numeric>

#include "tests/support/run_program.h"
#include "woodcock/base/temp_dir.h"

namespace woodcock::test {

using namespace compare;
namespace {

constexpr int width = 120, height = 90;

/// Smooth colours; `shift` moves them to the right.
std::vector<float> waves(double gain, int shift) {
    std::vector<float> rgb;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double u = x - shift;
            rgb.push_back(
                static_cast<float>(gain * (0.5 + 0.4 * std::sin(u / 9) * std::cos(y / 7.0))));
            rgb.push_back(static_cast<float>(gain * (0.3 + 0.2 * std::sin(u / 5))));
            rgb.push_back(static_cast<float>(gain * (0.6 + 0.3 * std::cos(y / 11.0))));
        }
    return rgb;
}

std::vector<float> flat(float r, float g, float b) {
    std::vector<float> rgb;
    for (int i = 0; i < width * height; ++i) rgb.insert(rgb.end(), {r, g, b});
    return rgb;
}

double mean(const std::vector<float>& v) {
    return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
}

TEST(Flip, EqualPicturesHaveNone) {
    const std::vector<float> a = waves(1, 0);
    for (const float v : flipLdr(a, a, width, height)) ASSERT_EQ(v, 0);
    for (const float v : flipHdr(a, a, width, height)) ASSERT_EQ(v, 0);
    const std::vector<float> black = flat(0, 0, 0);
    for (const float v : flipHdr(black, black, width, height)) ASSERT_EQ(v, 0);
}

// Section 4.1.3 of the paper: green against blue is the largest distance of all, whose error is 1.
TEST(Flip, GreenAgainstBlueIsTheLargest) {
    for (const float v : flipLdr(flat(0, 1, 0), flat(0, 0, 1), width, height))
        ASSERT_NEAR(v, 1, 1e-4);
}

// Flat greys differ in lightness alone. The largest distance is that of green and blue, whose
// CIELAB coordinates are tabulated, with chroma times a hundredth of lightness.
TEST(Flip, FlatGreysByHand) {
    const double l = 116 * (std::cbrt(0.36) - std::cbrt(0.18));
    const double a = 0.87737 * -86.185 - 0.32297 * 79.188, b = 0.87737 * 83.181 + 0.32297 * 107.860;
    const double largest = std::pow(87.737 - 32.297 + std::hypot(a, b), 0.7);
    const double expected = 0.95 / (0.4 * largest) * std::pow(l, 0.7);
    for (const float v :
         flipLdr(flat(0.18f, 0.18f, 0.18f), flat(0.36f, 0.36f, 0.36f), width, height))
        ASSERT_NEAR(v, expected, 1e-4);
}

TEST(Flip, HdrSeesWhatLdrClips) {
    const std::vector<float> a = flat(8, 8, 8), b = flat(16, 16, 16);
    EXPECT_NEAR(mean(flipLdr(a, b, width, height)), 0, 1e-6);
    EXPECT_GT(mean(flipHdr(a, b, width, height)), 0.05);
}

// What its authors' program, version 1.7, says of the same pictures.
TEST(Flip, AgreesWithItsAuthorsNumbers) {
    const std::vector<float> a = waves(1, 0), b = waves(1, 2);
    EXPECT_NEAR(mean(flipLdr(a, b, width, height)), 0.277937, 2e-5);
    EXPECT_NEAR(mean(flipHdr(a, b, width, height)), 0.277856, 2e-5);
}

/// The program itself, where Python has it (`pip install flip-evaluator numpy`): every pixel.
TEST(Flip, AgreesWithItsAuthorsProgram) {
    const TempDir dir;
    const std::string script = R"(
import sys
try:
    import numpy as np, flip_evaluator as flip
except ImportError:
    sys.exit(77)
y, x = np.mgrid[0:90, 0:120].astype(float)
def waves(gain, shift):
    u = x - shift
    return (gain * np.stack([.5 + .4 * np.sin(u / 9) * np.cos(y / 7), .3 + .2 * np.sin(u / 5),
                             .6 + .3 * np.cos(y / 11)], -1)).astype(np.float32)
for kind, gain in (("LDR", 1), ("HDR", 30)):
    error, _, _ = flip.evaluate(waves(gain, 0), waves(gain, 2), kind, False, False, True, {})
    np.asarray(error, np.float32).tofile(sys.argv[1] + "/" + kind)
)";
    const ProgramResult run =
        runProgram({"python3", "-c", script, dir.path().string()}, {}, "/usr/bin/env");
    if (run.exitCode != 0) GTEST_SKIP() << "no flip-evaluator for Python here: " << run.err;
    const auto expectEqual = [&](const std::vector<float>& ours, const char* kind) {
        const std::string bytes = readText(dir / kind);
        ASSERT_EQ(bytes.size(), ours.size() * sizeof(float));
        std::vector<float> theirs(ours.size());
        std::memcpy(theirs.data(), bytes.data(), bytes.size());
        for (std::size_t i = 0; i < ours.size(); ++i)
            ASSERT_NEAR(ours[i], theirs[i], 2e-4)
                << kind << " at " << i % width << ", " << i / width;
    };
    expectEqual(flipLdr(waves(1, 0), waves(1, 2), width, height), "LDR");
    expectEqual(flipHdr(waves(30, 0), waves(30, 2), width, height), "HDR");
}

}  // namespace
}  // namespace woodcock::test
