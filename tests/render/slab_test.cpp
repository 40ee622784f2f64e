// SPDX-License-Identifier: Apache-2.0
// Slabs of voxels through the whole program; tests/proof/slabs.cpp goes through tables of them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/expect_estimate.h"
#include "tests/support/paths.h"
#include "tests/support/read_back.h"
#include "tests/support/render_scene.h"
#include "tests/support/run_program.h"
#include "tests/support/write_vdb.h"

namespace woodcock::test {
namespace {

/// Layers of voxels in y, each of optical thickness proportional to `weights`, `depth` in all. The
/// linear ramps beyond the first and last layer belong to it: the sum over voxels is the integral.
/// One voxel is 1 high and `width` wide.
void writeSlab(const std::filesystem::path& file, double depth, const std::vector<double>& weights,
               double width) {
    double sum = 0;
    for (const double w : weights) sum += w;
    GridSpec grid;
    grid.box = {{0, 0, 0}, {15, static_cast<int>(weights.size()) - 1, 15}};
    grid.value = [=](Vec3i p) { return depth * weights[static_cast<std::size_t>(p.y)] / sum; };
    grid.worldFromIndex =
        Affine3d::translate({-7.5 * width, 0, -7.5 * width}) * Affine3d::scale({width, 1, width});
    writeVdb(file, {grid});
}
const std::vector<double> even{1, 1, 1, 1};
const std::vector<double> layered{5, 0, 1, 0.125, 0, 0, 8, 3, 0.5, 2, 0, 4};
constexpr double wide = 1e6;

/// A sky that is red above the horizon and blue below. Bilinear interpolation smears the horizon
/// over a row, an angle a = pi / rows. What leaves (or enters) a slab within a / 2 of its plane is
/// below sin^2(a / 2) of the flux: 4e-5 of the answer with 256 rows.
void writeSky(const std::filesystem::path& file) {
    constexpr int rows = 256, columns = 4;
    std::vector<float> rgb;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            for (const float v : {y < rows / 2 ? 1.0f : 0.0f, 0.0f, y < rows / 2 ? 0.0f : 1.0f})
                rgb.push_back(v);
    writeFloats(file, columns, rows, 3, rgb);
}

std::string slabScene(double albedo, double g, const std::string& light, int samples) {
    return fmt::format(
               "[[volume]]\nfile = \"slab.vdb\"\nscale = 1\nalbedo = {}\ng = {}\n"
               "{}[render]\nresolution = [32, 32]\nspp = {}\n",
               albedo, g, light, samples) +
           pencilCamera({0, 50, 0}, {0, -1, 0});
}
const std::string sky = "[[light]]\ntype = \"environment\"\nimage = \"sky.exr\"\n";

/// Reflectance and transmittance as the program renders them, from pixels that all look straight
/// down: by reciprocity the radiance seen is the slab's answer to a beam.
struct Answer {
    Estimate reflected, transmitted;
};
Answer throughTheProgram(const TempDir& dir, const std::string& scene) {
    writeText(dir / "slab.toml", scene);
    const ProgramResult run = runProgram(
        {"render", (dir / "slab.toml").string(), "-o", (dir / "slab.exr").string(), "--quiet"});
    EXPECT_EQ(run.exitCode, 0) << run.err;
    const ReadBack image = readBack(dir / "slab.exr");
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
    const TempDir dir;
    writeSky(dir / "sky.exr");
    writeSlab(dir / "slab.vdb", row.depth, row.layers, wide);
    const Answer a = throughTheProgram(dir, slabScene(row.albedo, row.g, sky, row.samples));
    expectAgrees(a.reflected, row.reflected, 5e-3);
    expectAgrees(a.transmitted, row.transmitted, 5e-3);
}

TEST(Slab, IsWideEnough) {
    const TempDir dir;
    writeSky(dir / "sky.exr");
    const auto reflected = [&](double width) {
        writeSlab(dir / "slab.vdb", 4, even, width);
        return throughTheProgram(dir, slabScene(1, 0, sky, 64)).reflected;
    };
    const Estimate infinite = reflected(wide);
    expectAgree(reflected(10 * wide), infinite, 5e-3);
    // The comparison can tell: of a slab as wide as high, light leaks through the sides.
    EXPECT_GT(infinite.mean - reflected(0.25).mean, 0.05);
}

}  // namespace
}  // namespace woodcock::test
