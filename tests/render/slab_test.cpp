// SPDX-License-Identifier: Apache-2.0
// Slabs of voxels through the whole program. lib/woodcock/proof/checks/slabs.cpp goes through
// tables of them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/expect_estimate.h"
#include "tests/support/run_program.h"
#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/support/read_back.h"

namespace woodcock::test {

using namespace proof;

namespace {

const std::vector<double> even{1, 1, 1, 1};
const std::vector<double> layered{5, 0, 1, 0.125, 0, 0, 8, 3, 0.5, 2, 0, 4};

std::string slabScene(double depth, double albedo, double g, int samples) {
    return fmt::format(
        "[[volume]]\nfile = \"slab.vdb\"\nscale = {}\nalbedo = {}\ng = {}\n"
        "{}[render]\nresolution = [32, 32]\nspp = {}\n{}",
        depth, albedo, g, proof::twoColouredSky, samples, proof::cameraAbove(1));
}

/// Reflectance and transmittance as the program renders them, from pixels that all look straight
/// down: by reciprocity the radiance seen is the slab's answer to a beam.
struct Answer {
    Estimate reflected, transmitted;
};
Answer throughTheProgram(const proof::Lab& lab, const std::string& scene) {
    writeText(lab.file("slab.toml"), scene);
    const ProgramResult run = runProgram(
        {"render", lab.file("slab.toml").string(), "-o", lab.file("slab.exr").string(), "--quiet"});
    EXPECT_EQ(run.exitCode, 0) << run.err;
    const ReadBack image = readBack(lab.file("slab.exr"));
    Moments red, blue;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            red.add(image.at(x, y, "R")), blue.add(image.at(x, y, "B"));
    return {Estimate(red), Estimate(blue)};
}

struct Row {
    double g, depth, albedo, reflected, transmitted;
    const std::vector<double>& layers;
    int samples;
};
void PrintTo(const Row& r, std::ostream* out) {
    *out << "g = " << r.g << ", depth " << r.depth << ", albedo " << r.albedo;
}
class Slab : public testing::TestWithParam<Row> {};

/// Adding-doubling with 64 nodes per hemisphere, beam at normal incidence, transmittance with the
/// unscattered part; g = 0.75, depth 2, albedo 0.9 is also in van de Hulst 1980. Optical depth is
/// the only coordinate of a slab: any layers of the same sum answer alike.
INSTANTIATE_TEST_SUITE_P(AddingDoubling, Slab,
                         testing::Values(Row{0, 4, 1, .690926, .309074, even, 128},
                                         Row{0.5, 1, 0.9, .129793, .739091, layered, 256},
                                         Row{0.75, 2, 0.9, .097395, .660958, layered, 256}));

TEST_P(Slab, ReflectsAndTransmitsAsTheTablesSay) {
    const Row& row = GetParam();
    const proof::Lab lab({});
    proof::writeTwoColouredSky(lab);
    proof::writeSlab(lab, "slab.vdb", row.layers);
    const Answer a = throughTheProgram(lab, slabScene(row.depth, row.albedo, row.g, row.samples));
    expectAgrees(a.reflected, row.reflected, 5e-3);
    expectAgrees(a.transmitted, row.transmitted, 5e-3);
}

TEST(Slab, IsWideEnough) {
    constexpr double wide = 1e6;
    const proof::Lab lab({});
    proof::writeTwoColouredSky(lab);
    const auto reflected = [&](double width) {
        proof::writeSlab(lab, "slab.vdb", even, width);
        return throughTheProgram(lab, slabScene(4, 1, 0, 64)).reflected;
    };
    const Estimate infinite = reflected(wide);
    expectAgree(reflected(10 * wide), infinite, 5e-3);
    // The comparison can tell: of a slab as wide as high, light leaks through the sides.
    EXPECT_GT(infinite.mean - reflected(0.25).mean, 0.05);
}

}  // namespace
}  // namespace woodcock::test
