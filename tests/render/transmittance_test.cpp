// SPDX-License-Identifier: Apache-2.0
// What camera rays lose, against exact integration of the voxels along them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/expect_estimate.h"
#include "tests/support/paths.h"
#include "woodcock/base/random.h"
#include "woodcock/medium/optical_depth.h"
#include "woodcock/proof/oracles/line_integral.h"
#include "woodcock/proof/oracles/vdb_values.h"
#include "woodcock/proof/support/render_scene.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace image;
using namespace medium;
using namespace oracle;
using namespace proof;
using namespace render;

namespace {

constexpr Box3i box{{-16, -8, 0}, {15, 15, 23}};

/// Noise in leaves with holes, with a constant tile in the middle and another that stands off.
double noise(Vec3i v) {
    for (int i = 0; i < 3; ++i)
        if (v[i] < box.lower[i] || v[i] > box.upper[i]) return 0;
    if (v.x >= 0 && v.x < 8 && v.y >= 0 && v.y < 8 && v.z >= 8 && v.z < 16) return 0.75;
    if (v.x < -8 && v.y < 0 && v.z < 8) return 0.25;
    const double u = RandomStream(hashOf(7, v.x, v.y, v.z)).uniform();
    return u < 0.4 ? 0 : u;
}

/// Sheared, mirrored, uneven.
const Affine3d worldFromIndex{{Vec3d{0.1, 0.01, 0}, {-0.02, 0.07, 0.01}, {0.03, 0, -0.2}},
                              {2, -1, 5}};

GridSpec noiseGrid() {
    GridSpec grid;
    grid.tiles = {{{0, 0, 8}, 8, {0.75}}, {{-16, -8, 0}, 8, {0.25}}};
    for (int x = box.lower.x; x <= box.upper.x; ++x)
        for (int y = box.lower.y; y <= box.upper.y; ++y)
            for (int z = box.lower.z; z <= box.upper.z; ++z) {
                const Vec3i v{x, y, z};
                const bool tile = (x >= 0 && x < 8 && y >= 0 && y < 8 && z >= 8 && z < 16) ||
                                  (x < -8 && y < 0 && z < 8);
                if (!tile && noise(v) > 0) grid.voxels.push_back({v, {noise(v)}});
            }
    grid.worldFromIndex = worldFromIndex;
    return grid;
}

struct IndexLine {
    const char* what;
    Vec3d origin, direction;
};
const std::vector<IndexLine> lines{
    {"across everything", {-40, -21, -13}, {1, 0.52, 0.61}},
    {"across tiles and leaves, backwards", {30, 14.2, 25.5}, {-1, -0.45, -0.5}},
    {"along a row of voxels", {-30, 3, 11}, {1, 0, 0}},
    {"along a row, between voxels", {-3.5, -30, 4.25}, {0, 1, 0}},
    {"in a plane of voxels", {-7, -30, 30}, {0, 0.8, -0.6}},
    {"grazes the last ramp", {-40, 15.5, 7.3}, {1, 0, 0}},
    {"grazes it at its very end", {-40, 15.99, 7.3}, {1, 0.0001, 0.0002}},
    {"grazes an edge", {-16.9, -8.9, -30}, {0, 0, 1}},
    {"starts inside a leaf", {-3.3, 9.1, 12.7}, {0.4, -0.7, 0.5}},
    {"starts inside a tile", {4.5, 3.5, 12.5}, {-0.3, 0.2, 1}},
    {"starts on a voxel", {-4, 8, 16}, {1, 1, 1}},
    {"starts at the end of the support", {16, 3.3, 8.1}, {-1, 0.1, 0.05}},
    {"misses", {-40, 17.5, 3}, {1, 0, 0}}};

double exactDepth(const IndexLine& line) {
    const Vec3d world = worldFromIndex.vector(line.direction);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    // The line integral counts index units; the ray's parameter counts world units.
    return lineIntegral(noise, box, line.origin, line.direction, 0, infinity) * length(world);
}

TEST(Transmittance, OfThinRaysThatAbsorb) {
    const TempDir dir;
    writeVdb(dir / "noise.vdb", {noiseGrid()});
    for (const IndexLine& line : lines) {
        SCOPED_TRACE(line.what);
        const Vec3d direction = normalize(worldFromIndex.vector(line.direction));
        const Scene scene = sceneFrom(
            "[[volume]]\nfile = \"noise.vdb\"\nscale = [1.2, 0.6, 0]\nalbedo = 0\n"
            "[[light]]\ntype = \"environment\"\nradiance = 2\n" +
                pencilCamera(worldFromIndex.point(line.origin), direction),
            dir.path());
        const double depth = exactDepth(line);
        const Film film = renderScene(scene, {32, 32, 512}).film;
        const std::array<double, 3> t{std::exp(-1.2 * depth), std::exp(-0.6 * depth), 1};
        expectAgrees(evenRadiance(film), {2 * t[0], 2 * t[1], 2}, 5e-3);
        const double opacity = 1 - (t[0] + t[1] + t[2]) / 3;
        const Estimate alpha = evenAlpha(film);
        EXPECT_NEAR(alpha.mean, opacity, 4 * alpha.error + 1e-6);
    }
}

TEST(Transmittance, AlphaOfWhatScatters) {
    const TempDir dir;
    writeVdb(dir / "noise.vdb", {noiseGrid()});
    for (const IndexLine& line : lines) {
        SCOPED_TRACE(line.what);
        const Scene scene = sceneFrom(
            "[[volume]]\nfile = \"noise.vdb\"\nsigma_a = [0.2, 0.1, 0]\nsigma_s = [1, 0.5, 0.3]\n"
            "g = 0.3\n[[light]]\ntype = \"environment\"\n" +
                pencilCamera(worldFromIndex.point(line.origin),
                             worldFromIndex.vector(line.direction)),
            dir.path());
        const double depth = exactDepth(line);
        const double t =
            (std::exp(-1.2 * depth) + std::exp(-0.6 * depth) + std::exp(-0.3 * depth)) / 3;
        const Estimate alpha = evenAlpha(renderScene(scene, {32, 32, 64}).film);
        EXPECT_NEAR(alpha.mean, 1 - t, 4 * alpha.error + 1e-6);
        EXPECT_LE(alpha.error, 2e-3);
    }
}

/// Random rays, many of which start inside: the walk of cells loses nothing and counts nothing
/// twice.
TEST(Transmittance, TheWalkSeesEveryVoxel) {
    const TempDir dir;
    writeVdb(dir / "noise.vdb", {noiseGrid()});
    const Scene scene = sceneFrom("[[volume]]\nfile = \"noise.vdb\"\nscale = [1, 2, 0.5]\n" +
                                      pencilCamera({0, 0, 0}, {0, 0, 1}),
                                  dir.path());
    RandomStream random(3);
    for (int i = 0; i < 2000; ++i) {
        const auto inBox = [&](double margin) {
            Vec3d p;
            for (int k = 0; k < 3; ++k)
                p[k] = box.lower[k] - margin +
                       random.uniform() * (box.upper[k] - box.lower[k] + 2 * margin);
            return i % 3 == 0 ? Vec3d{std::round(p.x), p.y, p.z} : p;
        };
        const Vec3d from = inBox(4), to = inBox(i % 5 == 0 ? 30 : 0);
        const Vec3d a = worldFromIndex.point(from), b = worldFromIndex.point(to);
        const double exact = lineIntegral(noise, box, from, to - from, 0, 1) * length(b - a);
        const Rgb depth = exactOpticalDepth(scene.medium, a, normalize(b - a), 0, length(b - a));
        EXPECT_NEAR(depth[0], exact, 2e-6 * exact + 1e-9) << i;
        EXPECT_NEAR(depth[1], 2 * exact, 4e-6 * exact + 1e-9) << i;
        EXPECT_NEAR(depth[2], exact / 2, 1e-6 * exact + 1e-9) << i;
    }
}

TEST(Transmittance, OfACloudFromProduction) {
    const std::filesystem::path teapot = sharedDir() / "assets" / "teapot_cloud.vdb";
    if (!std::filesystem::exists(teapot)) GTEST_SKIP() << "no " << teapot;
    const VdbValues values(teapot, "density");
    const VoxelFunction voxel = [&](Vec3i v) { return values.at(v); };
    const Affine3d indexFromWorld = values.worldFromIndex.inverse();
    const Vec3d inside =
        values.worldFromIndex.point((values.box.lower + values.box.upper).as<double>() * 0.5);
    RandomStream random(5);
    for (int i = 0; i < 15; ++i) {
        SCOPED_TRACE(i);
        const Vec3d target = inside + Vec3d{random.uniform() - 0.5, 0.4 * random.uniform() - 0.2,
                                            0.6 * random.uniform() - 0.3};
        const Vec3d direction = normalize(
            Vec3d{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5});
        const Vec3d eye = i % 3 == 0 ? target : target - direction * 3;
        const double integral = lineIntegral(voxel, values.box, indexFromWorld.point(eye),
                                             indexFromWorld.vector(direction), 0,
                                             std::numeric_limits<double>::infinity());
        // Thin enough that light comes through, which is where an error would show.
        const double scale = 1.5 / std::max(integral, 1.0);
        const double t = std::exp(-scale * integral);
        const std::string camera = pencilCamera(eye, direction);
        const auto scene = [&](const char* albedo) {
            return sceneFrom(fmt::format("[[volume]]\nfile = '{}'\nscale = {:.17g}\nalbedo = {}\n"
                                         "[[light]]\ntype = \"environment\"\n",
                                         teapot.string(), scale, albedo) +
                             camera);
        };
        expectAgrees(evenRadiance(renderScene(scene("0"), {32, 32, 256}).film), {t, t, t}, 5e-3);
        const Estimate alpha = evenAlpha(renderScene(scene("0.9"), {32, 32, 64, 0, 1}).film);
        EXPECT_NEAR(alpha.mean, 1 - t, 4 * alpha.error + 1e-6);
    }
}

}  // namespace
}  // namespace woodcock::test
