// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <tbb/global_control.h>

#include <cmath>

#include "tests/support/expect_error.h"
#include "tests/support/temp_dir.h"
#include "woodcock/convert/points_to_density.h"
#include "woodcock/base/random.h"
#include "woodcock/grid/openvdb_grids.h"

namespace woodcock::test {
namespace {

const openvdb::FloatGrid& only(const VdbGrids& grids) {
    EXPECT_EQ(grids.grids.size(), 1u);
    return static_cast<const openvdb::FloatGrid&>(*grids.grids.at(0));
}

PointCloud scattered(std::size_t count) {
    PointCloud cloud;
    RandomStream random(3);
    const auto number = [&](double low, double high) {
        return static_cast<float>(low + (high - low) * random.uniform());
    };
    for (std::size_t i = 0; i < count; ++i) {
        cloud.points.push_back({number(-5, 5), number(-3, 3), number(100, 104)});
        cloud.radii.push_back(number(0.4, 1.2));
        cloud.weights.push_back(number(0, 2));
    }
    return cloud;
}

TEST(PointsToDensity, VoxelsAreTheSumOfTheirPoints) {
    const PointCloud cloud = scattered(60);
    std::vector<std::string> notes;
    const VdbGrids grids = pointsToDensity(cloud, {.voxel = 0.1}, notes);
    const auto access = only(grids).getConstAccessor();
    RandomStream random(4);
    int reached = 0;
    for (int n = 0; n < 20000; ++n) {
        const openvdb::Coord at(static_cast<int>(random.uniform() * 120) - 60,
                                static_cast<int>(random.uniform() * 80) - 40,
                                static_cast<int>(random.uniform() * 60) + 990);
        double expected = 0;
        for (std::size_t i = 0; i < cloud.points.size(); ++i) {
            const Vec3d d =
                Vec3d{at.x() * 0.1, at.y() * 0.1, at.z() * 0.1} - cloud.points[i].as<double>();
            const auto radius = static_cast<double>(cloud.radii[i]);
            const double left = 1 - dot(d, d) / (radius * radius);
            if (left > 0) expected += static_cast<double>(cloud.weights[i]) * std::pow(left, 3);
        }
        EXPECT_NEAR(access.getValue(at), expected, 1e-6);
        if (expected > 1e-9) {
            ++reached;
            EXPECT_TRUE(access.isValueOn(at));
        }
    }
    EXPECT_GT(reached, 1000);
    EXPECT_TRUE(notes.empty());
}

double mass(const openvdb::FloatGrid& grid, double voxel) {
    double sum = 0;
    for (auto it = grid.cbeginValueOn(); it; ++it) sum += static_cast<double>(*it);
    return sum * voxel * voxel * voxel;
}

/// The integral of the kernel is 64 pi R^3 / 315.
TEST(PointsToDensity, MassIsTheSumOfThePoints) {
    const PointCloud cloud = scattered(60);
    double peaks = 0, weights = 0;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        const auto weight = static_cast<double>(cloud.weights[i]);
        weights += weight;
        peaks += weight * 64 * pi / 315 * std::pow(static_cast<double>(cloud.radii[i]), 3);
    }
    std::vector<std::string> notes;
    EXPECT_NEAR(mass(only(pointsToDensity(cloud, {.voxel = 0.1}, notes)), 0.1), peaks,
                1e-3 * peaks);
    EXPECT_NEAR(mass(only(pointsToDensity(cloud, {.voxel = 0.1, .normalised = true}, notes)), 0.1),
                weights, 1e-3 * weights);
}

TEST(PointsToDensity, SmallPointsKeepTheirMass) {
    PointCloud cloud = scattered(2000);
    double peaks = 0;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        cloud.radii[i] *= 0.05f;
        peaks += static_cast<double>(cloud.weights[i]) * 64 * pi / 315 *
                 std::pow(static_cast<double>(cloud.radii[i]), 3);
    }
    std::vector<std::string> notes;
    const VdbGrids grids = pointsToDensity(cloud, {.voxel = 0.1}, notes);
    EXPECT_NEAR(mass(only(grids), 0.1), peaks, 0.01 * peaks);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes[0].find("2000 of 2000"), std::string::npos) << notes[0];
}

TEST(PointsToDensity, ThreadsLeaveNoTrace) {
    const PointCloud cloud = scattered(500);
    std::vector<std::string> notes;
    const VdbGrids all = pointsToDensity(cloud, {.voxel = 0.1}, notes);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const VdbGrids alone = pointsToDensity(cloud, {.voxel = 0.1}, notes);
    ASSERT_TRUE(only(all).tree().hasSameTopology(only(alone).tree()));
    const auto access = only(alone).getConstAccessor();
    for (auto it = only(all).cbeginValueOn(); it; ++it)
        ASSERT_EQ(*it, access.getValue(it.getCoord()));
}

TEST(PointsToDensity, LimitsAreSaid) {
    std::vector<std::string> notes;
    expectError(ErrorKind::Input, "take voxels of at least", [&] {
        pointsToDensity(scattered(60), {.voxel = 0.01, .mostVoxels = 1000000}, notes);
    });
    expectError(ErrorKind::Input, "indices end at",
                [&] { pointsToDensity(scattered(1), {.voxel = 1e-12}, notes); });
    expectError(ErrorKind::Input, "no points", [&] { pointsToDensity({}, {.voxel = 1}, notes); });
}

TEST(PointsRead, TablesAndPlySayTheSame) {
    const TempDir dir;
    const char* const header =
        "element vertex 2\nproperty float x\nproperty float y\nproperty double z\n"
        "property uchar red\nproperty float width\nproperty float density\nend_header\n";
    writeText(dir / "a.ply", std::string("ply\nformat ascii 1.0\ncomment two\n") + header +
                                 "1 2 3 9 1 0.25\n-1 -2.5 -3e2 9 3 0.75\n");
    std::string binary = std::string("ply\nformat binary_little_endian 1.0\n") + header;
    const auto append = [&](auto v) { binary.append(reinterpret_cast<const char*>(&v), sizeof v); };
    append(1.f), append(2.f), append(3.0), binary += '\x9', append(1.f), append(0.25f);
    append(-1.f), append(-2.5f), append(-300.0), binary += '\x9', append(3.f), append(0.75f);
    writeText(dir / "b.ply", binary);
    writeText(dir / "a.csv", "1,2,3,0.5,0.25\n-1,-2.5,-3e2,1.5,0.75\n");
    writeText(dir / "b.csv",
              "\"Z\";value; id;X;Y;radius\r\n3;.25;7;1;2;0.5\r\n\r\n-300;.75;8;-1;-2.5;1.5");
    writeText(dir / "c.txt", "# x y z\n  1 2\t3 0.5 0.25 \n-1 -2.5 -300 +1.5 0.75\n");
    for (const char* name : {"a.ply", "b.ply", "a.csv", "b.csv", "c.txt"}) {
        const PointCloud cloud = readPoints(dir / name);
        EXPECT_EQ(cloud.points, (std::vector<Vec3f>{{1, 2, 3}, {-1, -2.5f, -300}})) << name;
        EXPECT_EQ(cloud.radii, (std::vector<float>{0.5f, 1.5f})) << name;
        EXPECT_EQ(cloud.weights, (std::vector<float>{0.25f, 0.75f})) << name;
    }
    // Whatever the bytes of a damaged file say: points or an error.
    RandomStream random(5);
    for (const char* name : {"a.ply", "b.ply", "b.csv"}) {
        const std::string healthy = readText(dir / name);
        for (int variant = 0; variant < 300; ++variant) {
            std::string bytes = healthy;
            if (variant % 3 == 0) bytes.resize(random.bits() % bytes.size());
            for (int i = 0; i < variant % 4 && !bytes.empty(); ++i)
                bytes[random.bits() % bytes.size()] ^= static_cast<char>(1 << random.bits() % 8);
            writeText(dir / name, bytes);
            try {
                EXPECT_FALSE(readPoints(dir / name).points.empty());
            } catch (const Error& e) {
                EXPECT_NE(std::string(e.what()).find(name), std::string::npos) << e.what();
            }
        }
    }
}

TEST(PointsRead, ErrorsNameLineAndColumn) {
    const TempDir dir;
    const auto expectBad = [&](const char* name, const std::string& text, const char* part) {
        writeText(dir / name, text);
        expectError(ErrorKind::Input, part, [&] { readPoints(dir / name); });
    };
    expectBad("a.csv", "x,y,z\n1,2,3\n1, two,3\n", "a.csv:3:4: 'two' where a number is expected");
    expectBad("a.csv", "x,y,z\n1,2\n", "a.csv:2: 2 columns where 3 are expected");
    expectBad("a.csv", "x,y\n1,2\n", "expected one x, one y and one z");
    expectBad("a.csv", "x,y,z\n1,nan,2\n", "a.csv:2:3: 'nan'");
    expectBad("a.csv", "", "holds no points");
    expectBad("a.ply", "words", "is no PLY file");
    expectBad("a.ply",
              "ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nend_header\n",
              "99999999999 of element 'vertex'");
    expectBad("a.las", "", "ends in '.las', where .ply, .csv, .txt or .xyz");
}

}  // namespace
}  // namespace woodcock::test
