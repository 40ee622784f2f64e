// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "tests/support/expect_error.h"
#include "woodcock/base/random.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/convert/points_to_density.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::test {

using namespace convert;
using namespace grid;
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
        cloud.points.push_back(Vec3f{number(-5, 5), number(-3, 3), number(100, 104)}.as<double>());
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
            const Vec3d d = Vec3d{at.x() * 0.1, at.y() * 0.1, at.z() * 0.1} - cloud.points[i];
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
    expectError(ErrorKind::Input, "beyond the largest index",
                [&] { pointsToDensity(scattered(1), {.voxel = 1e-12}, notes); });
    expectError(ErrorKind::Input, "no points", [&] { pointsToDensity({}, {.voxel = 1}, notes); });
}

/// As the coordinates of maps: floats would make layers of them.
TEST(PointsToDensity, FarFromTheOriginItIsTheSameMoved) {
    const Vec3d far{512345, -5412345, 300};
    const PointCloud here = scattered(300);
    PointCloud there = here;
    for (Vec3d& p : there.points) p += far;
    std::vector<std::string> notes;
    const VdbGrids near = pointsToDensity(here, {.voxel = 0.1}, notes);
    const VdbGrids moved = pointsToDensity(there, {.voxel = 0.1}, notes);
    const openvdb::FloatGrid& grid = only(moved);
    const auto access = grid.getConstAccessor();
    double worst = 0, reached = 0;
    for (auto it = only(near).cbeginValueOn(); it; ++it, ++reached) {
        const openvdb::Vec3d p = only(near).indexToWorld(it.getCoord());
        const openvdb::Vec3d q = grid.worldToIndex(p + openvdb::Vec3d(far.x, far.y, far.z));
        worst = std::max(worst, double(std::abs(access.getValue(openvdb::Coord::round(q)) - *it)));
    }
    EXPECT_GT(reached, 10000);
    EXPECT_LT(worst, 1e-6);
    EXPECT_NEAR(mass(grid, 0.1), mass(only(near), 0.1), 1e-6 * mass(grid, 0.1));
    // The transform has the place, and indices are small.
    EXPECT_LT(std::abs(grid.evalActiveVoxelBoundingBox().min().y()), 1000);
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
    writeText(dir / "a.csv", "x,y,z,pscale,weight\n1,2,3,0.5,0.25\n-1,-2.5,-3e2,1.5,0.75\n");
    writeText(dir / "b.csv",
              "\"Z\";value; id;X;Y;radius\r\n3;.25;7;1;2;0.5\r\n\r\n-300;.75;8;-1;-2.5;1.5");
    writeText(
        dir / "c.txt",
        "# made by hand\n# x y z radius density\n  1 2\t3 0.5 0.25 \n-1 -2.5 -300 +1.5 0.75\n");
    for (const char* name : {"a.ply", "b.ply", "a.csv", "b.csv", "c.txt"}) {
        const PointCloud cloud = readPoints(dir / name);
        EXPECT_EQ(cloud.points, (std::vector<Vec3d>{{1, 2, 3}, {-1, -2.5, -300}})) << name;
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

const std::vector<Vec3d> twoPoints{{0.5, 2, 3}, {-1, 2.5, 4}};

TEST(PointsRead, TablesAsProgramsWriteThem) {
    const std::pair<const char*, std::string> tables[]{
        {"Excel", "\xef\xbb\xbfx,y,z\r\n0.5,2,3\r\n-1,2.5,4\r\n"},
        {"Excel in Europe", "\xef\xbb\xbfX;Y;Z\r\n0,5;2;3\r\n-1;2,5;4\r\n"},
        {"CloudCompare", "//X Y Z\n0.5 2 3\n-1 2.5 4\n"},
        {"CloudCompare's header of a count", "//X Y Z R G B\n0.5 2 3 1 1 1\n-1 2.5 4 1 1 1\n"},
        {"gnuplot", "# X Y Z\n# metres\n\n0.5\t2\t3\n-1\t2.5\t4\n"},
        {"MATLAB", "% x y z\n0.5 2 3\n-1 2.5 4"},
        {"PDAL", "\"X\",\"Y\",\"Z\",\"Intensity\"\n0.500,2.000,3.000,7\n-1.000,2.500,4.000,8\n"},
        {"ParaView", "\"T\",\"Points:0\",\"Points:1\",\"Points:2\"\n300,0.5,2,3\n300,-1,2.5,4\n"},
        {"units", "x (m),y [m],Z (m)\n0.5,2,3\n-1,2.5,4\n"},
        {"names with commas", "\"x\",\"colour, red\",\"y\",\"z\"\n0.5,1,2,3\n-1,1,2.5,4\n"},
        {"tabs and decimal commas", "x\ty\tz\n0,5\t2\t3\n-1\t2,5\t4\n"},
        {"spaces and decimal commas", "x y z\n0,5 2,0 3,0\n-1,0 2,5 4,0\n"},
        {"commas and spaces", "x, y, z\n0.5, 2, 3\n-1, 2.5, 4\n"},
        {"words in a column", "name,x,y,z\nfirst,0.5,2,3\n\"a, b\",-1,2.5,4\n"},
        {"an old Macintosh", "x,y,z\r0.5,2,3\r-1,2.5,4\r"},
        {"many digits", "0.50000000000000000 2.000 3\n-1.0 2.5 4\n"}};
    const TempDir dir;
    for (const auto& [who, text] : tables) {
        writeText(dir / "a.csv", text);
        const PointCloud cloud = readPoints(dir / "a.csv");
        EXPECT_EQ(cloud.points, twoPoints) << who;
        EXPECT_TRUE(cloud.radii.empty()) << who;
        EXPECT_EQ(cloud.notes.empty(), text.find("0,5") == text.npos) << who;
    }
}

TEST(PointsRead, WhatColumnsWereTakenForIsSaid) {
    const TempDir dir;
    writeText(dir / "a.xyz", "0.5 2 3 103\n-1 2.5 4 61\n");
    const PointCloud plain = readPoints(dir / "a.xyz");
    EXPECT_EQ(plain.points, twoPoints);
    EXPECT_TRUE(plain.radii.empty());
    EXPECT_EQ(plain.columns, "column 1 is x, column 2 is y, column 3 is z, column 4 is not used");
    ASSERT_EQ(plain.notes.size(), 1u);
    EXPECT_NE(plain.notes[0].find("--columns x,y,z,radius"), std::string::npos);
    const PointCloud chosen = readPoints(dir / "a.xyz", "x,y,z,width");
    EXPECT_EQ(chosen.radii, (std::vector<float>{51.5f, 30.5f}));
    EXPECT_TRUE(chosen.notes.empty());
    // Columns that are given stand above the names in the file.
    writeText(dir / "a.csv", "north,east,up\n2,0.5,3\n2.5,-1,4\n");
    EXPECT_EQ(readPoints(dir / "a.csv", "y,x,z").points, twoPoints);
    writeText(dir / "a.csv", "x,y,z,Intensity\n0.5,2,3,9\n-1,2.5,4,9\n");
    EXPECT_EQ(readPoints(dir / "a.csv").columns,
              "'x' is x, 'y' is y, 'z' is z, 'Intensity' is not used");
    expectError(ErrorKind::Usage, "'intensity' is not one of x, y, z",
                [&] { readPoints(dir / "a.csv", "x,y,z,intensity"); });
    expectError(ErrorKind::Usage, "does not name x, y and z",
                [&] { readPoints(dir / "a.csv", "x,y"); });
}

TEST(PointsRead, CoordinatesOfMapsKeepTheirDigits) {
    const TempDir dir;
    writeText(dir / "a.csv", "x,y,z\n512345.678901,-5412345.123457,6371000.000001\n");
    const std::vector<Vec3d> expected{{512345.678901, -5412345.123457, 6371000.000001}};
    EXPECT_EQ(readPoints(dir / "a.csv").points, expected);
    std::string bytes =
        "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty double x\n"
        "property double y\nproperty double z\nend_header\n";
    for (int a = 0; a < 3; ++a) {
        const double v = expected[0][a];
        std::string number(reinterpret_cast<const char*>(&v), sizeof v);
        bytes.append(number.rbegin(), number.rend());
    }
    writeText(dir / "a.ply", bytes);
    EXPECT_EQ(readPoints(dir / "a.ply").points, expected);
}

TEST(PointsRead, ErrorsNameLineAndColumn) {
    const TempDir dir;
    const auto expectBad = [&](const char* name, const std::string& text, const char* part) {
        writeText(dir / name, text);
        expectError(ErrorKind::Input, part, [&] { readPoints(dir / name); });
    };
    expectBad("a.csv", "x,y,z\n1,2,3\n1, two,3\n", "a.csv:3:4: 'two' is not a number");
    expectBad("a.csv", "x,y,z\n1,2\n", "a.csv:2: 2 columns; expected 3");
    expectBad("a.csv", "x,y\n1,2\n",
              "expected one x, one y and one z of each point; found: 'x' is x, 'y' is y");
    expectBad("a.csv", "1,2\n", "a.csv:1: 2 numbers; expected x, y and z");
    expectBad("a.csv", "x,y,z\n0,5,2,0,3,0\n", "6 columns; expected 3; if commas are");
    expectBad("a.csv", std::string("\xff\xfex\0,\0", 6),
              "a.csv is text in UTF-16; save it as text in UTF-8");
    expectBad("a.csv", std::string("x\0,\0y\0", 6), "UTF-16");
    expectBad("a.csv", "x;y;z\n1,000,000;2;3\n", "'1,000,000' is not a number");
    expectBad("a.csv", "x,y,z\n1,nan,2\n", "a.csv:2:3: 'nan'");
    expectBad("a.csv", "", "holds no points");
    expectBad("a.ply", "words", "is not a PLY file");
    expectBad("a.ply",
              "ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nend_header\n",
              "99999999999 of element 'vertex'");
    expectBad("a.las", "", "ends in '.las'; expected .ply, .csv, .txt or .xyz");
}

}  // namespace
}  // namespace woodcock::test
