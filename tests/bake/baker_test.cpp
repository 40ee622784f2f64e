// SPDX-License-Identifier: Apache-2.0
#include "woodcock/bake/baker.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/bake/recipe_text.h"
#include "tests/support/paths.h"
#include "woodcock/bake/bake_file.h"
#include "woodcock/bake/program.h"
#include "woodcock/base/error.h"
#include "woodcock/base/random.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::test {

using namespace bake;
using namespace grid;
namespace {

template <class Grid = openvdb::FloatGrid>
typename Grid::Ptr gridOf(const Bake& bake, std::size_t i = 0) {
    return openvdb::gridPtrCast<Grid>(bake.grids->grids[i]);
}

Bake bakeOf(const Recipe& recipe, double voxel, int threads = 0) {
    BakeSettings settings = cubicVoxels(voxel);
    settings.threads = threads;
    return *bakeRecipe(recipe, settings);
}

Vec3d worldOf(const openvdb::GridBase& grid, openvdb::Coord at) {
    const openvdb::Vec3d p = grid.indexToWorld(at);
    return {p.x(), p.y(), p.z()};
}

double mass(const openvdb::FloatGrid& grid) {
    double sum = 0;
    for (auto v = grid.cbeginValueOn(); v; ++v)
        sum += double(*v) * static_cast<double>(v.getVoxelCount());
    return sum * grid.voxelSize().product();
}

/// Every active voxel against a formula at its position.
template <class F>
void expectFormula(const openvdb::FloatGrid& grid, double tolerance, const F& formula) {
    std::uint64_t count = 0;
    for (auto v = grid.cbeginValueOn(); v; ++v, ++count) {
        openvdb::CoordBBox box;
        v.getBoundingBox(box);
        for (const openvdb::Coord& c : {box.min(), box.max()})
            ASSERT_NEAR(*v, formula(worldOf(grid, c)), tolerance) << c;
    }
    EXPECT_GT(count, 1000u);
}

TEST(Baker, LinearRampMatchesItsFormula) {
    const Bake bake = bakeOf(recipeOf("[node.thing]\ntype = \"remap\"\nfrom = [-2, 2]\n"
                                      "input = { type = \"position\", of = \"y\" }"),
                             0.1);
    expectFormula(*gridOf(bake), 1e-6, [](Vec3d p) { return (p.y + 2) / 4; });
    // A plane of voxels at y = -2 is zero, the others average to half: 41 x 41 voxels a plane.
    EXPECT_NEAR(mass(*gridOf(bake)), 41 * 41 * 41 * 0.5 * 1e-3, 1e-4);
}

TEST(Baker, BallMatchesItsFormulaAndMass) {
    const Bake bake = bakeOf(recipeOf("[node.thing]\ntype = \"falloff\"\nedge = 0.5\n"
                                      "profile = \"linear\"\n"
                                      "input = { type = \"sphere\", radius = 1.5 }"),
                             0.05);
    const auto density = [](double r) { return std::clamp((1.5 - r) / 0.5, 0.0, 1.0); };
    expectFormula(*gridOf(bake), 1e-6, [&](Vec3d p) { return density(length(p)); });
    // 4 pi times the integral of r^2 density: the core, and a linear shell.
    const double core = 1.0 / 3, shell = (1.5 * (3.375 - 1) / 3 - (5.0625 - 1) / 4) / 0.5;
    EXPECT_NEAR(mass(*gridOf(bake)), 4 * pi * (core + shell), 2e-3 * 4 * pi * (core + shell));
    EXPECT_GT(bake.statistics[0].tiles, 0u) << "the inside is constant";
    EXPECT_EQ(bake.statistics[0].atBounds, (std::array<std::uint64_t, 6>{}));
}

TEST(Baker, GaussianMatchesItsFormulaAndMass) {
    const Bake bake =
        bakeOf(recipeOf("[node.r]\ntype = \"position\"\nof = \"radius\"\n"
                        "[node.thing]\ntype = \"exp\"\n"
                        "input = { type = \"multiply\", inputs = [-12.5, \"r\", \"r\"] }"),
               0.05);
    expectFormula(*gridOf(bake), 1e-6, [](Vec3d p) { return std::exp(-12.5 * dot(p, p)); });
    // Trapezoidal sums of a Gaussian converge faster than any power: sigma is four voxels.
    EXPECT_NEAR(mass(*gridOf(bake)), std::pow(2 * pi * 0.04, 1.5), 1e-6);
}

constexpr const char* everything = R"(
[node.puffs]
type = "puffs"
count = 3
radius = [0.3, 0.5]
spread = 0.8
blend = 0.2
over = "ball"
[node.box]
type = "box"
centre = [0.5, 0.5, 0]
size = [0.5, 0.7, 0.9]
rounding = 0.1
[node.ring]
type = "transform"
rotate = [20, 30, 40]
scale = [1, 0.7, 1]
translate = [-0.7, 0.3, 0.1]
input = { type = "ring", radius = 0.6, thickness = 0.15 }
[node.shapes]
type = "smooth_min"
width = 0.3
inputs = ["puffs", "box", "ring",
    { type = "capsule", from = [-1, -1, 0], to = [0, 1, 1], radius = 0.2 },
    { type = "menger", centre = [1, -1, -1], size = 0.8, levels = 3 }]
[node.flow]
type = "curl"
size = 0.7
octaves = 2
[node.moved]
type = "warp"
input = "shapes"
by = "flow"
amount = [0.1, 0.05, 0.1]
[node.noise]
type = "add"
inputs = [{ type = "fbm", size = 0.5, basis = "worley", value = "border", octaves = 3 },
    { type = "ridged", size = [0.5, 1, 0.5], octaves = 3, evolution = 0.4 },
    { type = "billow", size = 0.4, basis = "simplex", octaves = 2 }]
[node.surface]
type = "smooth_max"
width = 0.1
inputs = [{ type = "displace", input = "moved", by = "noise", amount = 0.15 },
    { type = "plane", normal = [0.1, -1, 0.2], offset = 0.8 }]
[node.soft]
type = "falloff"
input = "surface"
edge = 0.2
[node.speckle]
type = "abs"
input = { type = "perlin", size = 0.3 }
[node.slope]
type = "remap"
from = [-1, 1]
profile = "smooth"
input = { type = "position" }
[node.blend]
type = "multiply"
inputs = ["soft", { type = "mix", a = "soft", b = 0.9, by = "slope" }]
[node.thing]
type = "max"
inputs = [{ type = "erode", input = "soft", amount = 0.4, by = "speckle" },
    { type = "power", exponent = 0.7, input = "blend" }]
)";

// Every voxel within the recipe's bounds, one by one and far from any other: the same bits.
TEST(Baker, SparseEqualsDenseBitForBit) {
    const Recipe recipe = recipeOf(everything);
    const double voxel = 0.07;
    const Bake bake = bakeOf(recipe, voxel);
    const openvdb::FloatGrid::Ptr grid = gridOf(bake);
    const auto accessor = grid->getConstAccessor();
    const int last = static_cast<int>(2 / voxel);
    std::vector<Vec3d> positions;
    for (int x = -last - 2; x <= last + 2; ++x)
        for (int y = -last; y <= last; ++y)
            for (int z = -last; z <= last; ++z)
                positions.push_back(Vec3d{x * voxel, y * voxel, z * voxel});
    const std::vector<Vec3d> values = evaluateRecipe(recipe, 0, positions);
    std::size_t i = 0, filled = 0;
    for (int x = -last - 2; x <= last + 2; ++x)
        for (int y = -last; y <= last; ++y)
            for (int z = -last; z <= last; ++z, ++i) {
                const bool inside = std::abs(x) <= last;
                const float expected = inside ? static_cast<float>(values[i].x) : 0;
                ASSERT_EQ(accessor.getValue({x, y, z}), expected) << x << " " << y << " " << z;
                ASSERT_EQ(accessor.isValueOn({x, y, z}), expected != 0);
                filled += expected != 0;
            }
    EXPECT_GT(filled, 5000u);
    EXPECT_LT(bake.evaluatedVoxels, i) << "nothing was left out";
}

// The bound of every node contains what it says at points of random boxes.
TEST(Baker, BoundsContainAllValues) {
    const Recipe recipe = recipeOf(everything);
    std::vector<int> roots;
    for (std::size_t i = 0; i < recipe.graph.entries.size(); ++i)
        roots.push_back(static_cast<int>(i));
    const Program program(recipe.graph, roots);
    Program::Workspace bounding, evaluating;
    RandomStream random(11);
    const auto draw = [&] {
        const double x = random.uniform(), y = random.uniform(), z = random.uniform();
        return Vec3d{x, y, z};
    };
    for (int round = 0; round < 400; ++round) {
        const double size = std::pow(10, -4 + 4.5 * random.uniform());
        const Vec3d low = (draw() * 2 - Vec3d{1, 1, 1}) * 2;
        const Box3d box{low, low + draw() * size};
        std::array<std::array<double, 64>, 3> at;
        Points points{.count = 64};
        for (std::size_t i = 0; i < 64; ++i) {
            const Vec3d t =
                i < 8 ? Vec3d{i & 1 ? 1.0 : 0, i & 2 ? 1.0 : 0, i & 4 ? 1.0 : 0} : draw();
            for (int c = 0; c < 3; ++c)
                at[static_cast<std::size_t>(c)][i] =
                    std::clamp(low[c] + t[c] * box.size()[c], box.lower[c], box.upper[c]);
            points.box.add(Vec3d{at[0][i], at[1][i], at[2][i]});
        }
        for (std::size_t c = 0; c < 3; ++c) points.at[c] = at[c].data();
        const std::vector<Bounds> bounds = program.bound(box, bounding);
        const std::vector<Values> values = program.evaluate(points, evaluating);
        for (std::size_t root = 0; root < roots.size(); ++root)
            for (std::size_t c = 0; c < 3; ++c)
                for (std::size_t i = 0; i < 64; ++i)
                    ASSERT_TRUE(bounds[root][c].contains(values[root].channel[c][i]))
                        << "entry " << root << ": " << values[root].channel[c][i] << " is not in ["
                        << bounds[root][c].lower << ", " << bounds[root][c].upper << "]";
    }
}

TEST(Baker, ThreadsMakeNoDifference) {
    const TempDir dir;
    const Recipe recipe = recipeOf(everything);
    VdbWriteOptions options;
    for (const int threads : {1, 2, 5})
        writeBake(dir / fmt::format("{}.vdb", threads), bakeOf(recipe, 0.05, threads), options, 0);
    const std::string one = readText(dir / "1.vdb");
    EXPECT_EQ(one, readText(dir / "2.vdb"));
    EXPECT_EQ(one, readText(dir / "5.vdb"));
}

TEST(Baker, MasksLimitOtherGrids) {
    const Recipe recipe = makeRecipe({R"([bounds]
min = [-2, -2, -2]
max = [2, 2, 2]
[[output]]
name = "density"
node = { type = "falloff", edge = 0.3, input = { type = "sphere", radius = 1.5 } }
[[output]]
name = "vel"
mask = "density"
node = { type = "vector", x = { type = "position", of = "y" }, y = 2, z = 0 }
[[output]]
name = "plain"
mask = "density"
node = 3
)",
                                      "t", ""},
                                     {});
    const Bake bake = bakeOf(recipe, 0.05);
    const auto density = gridOf(bake, 0);
    const auto velocity = gridOf<openvdb::Vec3SGrid>(bake, 1);
    const auto plain = gridOf(bake, 2);
    EXPECT_EQ(density->activeVoxelCount(), velocity->activeVoxelCount());
    EXPECT_EQ(density->activeVoxelCount(), plain->activeVoxelCount());
    for (auto v = velocity->cbeginValueOn(); v; ++v) {
        const openvdb::Coord c = v.getCoord();
        ASSERT_TRUE(density->tree().isValueOn(c));
        ASSERT_NEAR((*v).x(), worldOf(*velocity, c).y, 1e-6);
        ASSERT_EQ((*v).y(), 2);
    }
    for (auto v = plain->cbeginValueOn(); v; ++v) ASSERT_EQ(*v, 3);
}

TEST(Baker, ToleranceLeavesOutAndMerges) {
    const std::string nodes =
        "[node.thing]\ntype = \"falloff\"\nedge = 1\n"
        "input = { type = \"sphere\", radius = 1.5 }";
    Recipe recipe = recipeOf(nodes);
    const Bake exact = bakeOf(recipe, 0.05);
    recipe.outputs[0].tolerance = 0.01;
    const Bake loose = bakeOf(recipe, 0.05);
    EXPECT_LT(gridOf(loose)->activeVoxelCount(), gridOf(exact)->activeVoxelCount());
    const auto accessor = gridOf(loose)->getConstAccessor();
    for (auto v = gridOf(exact)->cbeginValueOn(); v; ++v)
        ASSERT_NEAR(*v, accessor.getValue(v.getCoord()), 0.0101);
}

TEST(Baker, RefusesWhatCannotBe) {
    const auto mistake = [](const Recipe& recipe, const BakeSettings& settings) -> std::string {
        try {
            bakeRecipe(recipe, settings);
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::Input);
            return e.what();
        }
        return "no error";
    };
    const auto expect = [&](const Recipe& recipe, const BakeSettings& settings,
                            const std::string& part) {
        const std::string found = mistake(recipe, settings);
        EXPECT_NE(found.find(part), std::string::npos) << found;
    };
    const Recipe nothing = recipeOf("[node.thing]\ntype = \"abs\"\ninput = 0");
    expect(nothing, cubicVoxels(0.1), "is at most 0 everywhere within the recipe's bounds");
    const Recipe dust = recipeOf(
        "[node.thing]\ntype = \"falloff\"\nedge = 1\n"
        "input = { type = \"sphere\", centre = [0.05, 0.05, 0.05], "
        "radius = 0.01 }");
    expect(dust, cubicVoxels(0.1), "smaller than the voxels");
    const Recipe off = recipeOf("[node.thing]\ntype = \"abs\"\ninput = 1", "thing",
                                "min = [0.1, 0, 0]\nmax = [0.2, 1, 1]");
    expect(off, cubicVoxels(1), "no voxel lies within");
    const Recipe wild = recipeOf(
        "[node.thing]\ntype = \"exp\"\ninput = { type = \"multiply\", "
        "inputs = [500, { type = \"position\", of = \"x\" }] }");
    expect(wild, cubicVoxels(0.5), "is not finite at ");
    expect(wild, cubicVoxels(0.5), "first at [1, -4, -4]");
    const Recipe level = recipeOf("[node.thing]\ntype = \"exp\"\ninput = 500");
    expect(level, cubicVoxels(0.1), "is not finite at 68921 voxels, first at [-20, -20, -20]");
    BakeSettings fine = cubicVoxels(2e-5);
    fine.mostVoxels = 1e8;
    expect(recipeOf(everything), fine, "--max-voxels");
    expect(recipeOf(everything), cubicVoxels(1e-12), "too small for a VDB file");
    expect(recipeOf(everything, "thing", "min = [-1e5, 0, 0]\nmax = [1e5, 1, 1]"),
           cubicVoxels(5e-5), "larger voxels");
    BakeSettings some = cubicVoxels(0.01);
    some.mostVoxels = 1e5;
    expect(recipeOf(everything), some, "--max-voxels");
}

TEST(Baker, StopsWhenTold) {
    EXPECT_FALSE(bakeRecipe(recipeOf(everything), cubicVoxels(0.02), [](double) { return false; }));
}

TEST(Baker, TransformsOfAnyKind) {
    const Recipe recipe = recipeOf(
        "[node.thing]\ntype = \"falloff\"\nedge = 1\n"
        "input = { type = \"sphere\", radius = 1.5 }");
    BakeSettings settings;
    settings.worldFromIndex = Affine3d::translate({0.3, 0.1, 0.2}) * Affine3d::rotate(1, 30) *
                              Affine3d::scale({0.1, 0.05, 0.08});
    const Bake bake = *bakeRecipe(recipe, settings);
    const auto grid = gridOf(bake);
    for (auto v = grid->cbeginValueOn(); v; ++v) {
        const double t = std::clamp(1.5 - length(worldOf(*grid, v.getCoord())), 0.0, 1.0);
        ASSERT_NEAR(*v, t * t * (3 - 2 * t), 1e-6);
    }
    EXPECT_NEAR(static_cast<double>(grid->activeVoxelCount()) * 0.1 * 0.05 * 0.08,
                4 * pi / 3 * 1.5 * 1.5 * 1.5, 0.2);
}

TEST(BakeFile, CoarserLevelsKeepMassAndPlace) {
    const TempDir dir;
    const Bake bake = bakeOf(recipeOf("[node.thing]\ntype = \"falloff\"\nedge = 1\n"
                                      "input = { type = \"sphere\", radius = 1.5 }"),
                             0.05);
    const auto files = writeBake(dir / "ball.vdb", bake, {}, 2);
    ASSERT_EQ(files.size(), 3u);
    double voxel = 0.05;
    for (const auto& file : files) {
        openvdb::io::File in(file.string());
        in.open();
        const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(in.readGrid("density"));
        EXPECT_NEAR(grid->voxelSize().x(), voxel, 1e-12);
        EXPECT_NEAR(mass(*grid), mass(*gridOf(bake)), 0.01 * mass(*gridOf(bake))) << file;
        EXPECT_EQ(grid->tree().getValue({0, 0, 0}), 1);
        voxel *= 2;
    }
}

// Sampled anew on its own voxels, a grid is itself.
TEST(BakeFile, GridsOfAFileAreTheSameOnTheirOwnVoxels) {
    const TempDir dir;
    BakeSettings settings;
    settings.worldFromIndex =
        Affine3d::translate({0.123, -5.1, 7.77}) * Affine3d::scale({0.07, 0.07, 0.07});
    const Recipe recipe = recipeOf(
        "[node.thing]\ntype = \"falloff\"\nedge = 0.2\ninput = { type = \"displace\", amount = "
        "0.4, "
        "by = { type = \"fbm\", size = 0.4 }, input = { type = \"sphere\", radius = 1, "
        "centre = [0, -5, 8] } }",
        "thing", "min = [-2, -7, 6]\nmax = [2, -3, 10]");
    const Bake first = *bakeRecipe(recipe, settings);
    writeBake(dir / "a.vdb", first, {}, 0);
    const Recipe again = makeRecipe(recipeOfGrids(dir / "a.vdb"), {});
    settings.worldFromIndex = transformOf(dir / "a.vdb", "");
    const Bake second = *bakeRecipe(again, settings);
    EXPECT_EQ(gridOf(first)->activeVoxelCount(), gridOf(second)->activeVoxelCount());
    const auto accessor = gridOf(second)->getConstAccessor();
    for (auto v = gridOf(first)->cbeginValueOn(); v; ++v) {
        openvdb::CoordBBox box;
        v.getBoundingBox(box);
        ASSERT_EQ(*v, accessor.getValue(box.min()));
        ASSERT_EQ(*v, accessor.getValue(box.max()));
    }
}

}  // namespace
}  // namespace woodcock::test
