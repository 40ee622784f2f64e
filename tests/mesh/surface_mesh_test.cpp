// SPDX-License-Identifier: Apache-2.0
#include "woodcock/mesh/surface_mesh.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/expect_error.h"
#include "tests/support/mesh_volume.h"
#include "woodcock/base/random.h"
#include "woodcock/base/temp_dir.h"

namespace woodcock::test {

using namespace mesh;
namespace {

#define NEEDS_ASSIMP() \
    if (!canReadMeshes()) GTEST_SKIP() << "this build has no Assimp"

std::vector<std::array<double, 2>> circle(int steps) {
    std::vector<std::array<double, 2>> profile;
    for (int i = 0; i <= steps; ++i) {
        const double angle = pi * (static_cast<double>(i) / steps - 0.5);
        profile.push_back({i == 0 || i == steps ? 0 : std::cos(angle), std::sin(angle)});
    }
    return profile;
}

void expectClosed(const SurfaceMesh& mesh) {
    const Closedness closed = checkClosed(mesh.mesh);
    EXPECT_TRUE(closed.closed) << closed.problem;
    EXPECT_FALSE(closed.inwards);
    EXPECT_EQ(closed.problem, "");
}

TEST(SurfaceMesh, BoxesAndLathesAreClosedAndOfTheirVolume) {
    const SurfaceMesh box = boxMesh({{1, 2, 3}, {2, 4, 6}});
    expectClosed(box);
    EXPECT_NEAR(volume(box.mesh), 6, 1e-6);
    ASSERT_EQ(box.uvs.size(), 12u);

    const SurfaceMesh ball = latheMesh(circle(64), 128, 180);
    expectClosed(ball);
    EXPECT_NEAR(volume(ball.mesh), 4 * pi / 3, 0.01);

    // A ring of square section, whose profile ends where it starts: Pappus, with a polygon for the
    // circle.
    const std::vector<std::array<double, 2>> square{{2, 0}, {3, 0}, {3, 1}, {2, 1}, {2, 0}};
    const SurfaceMesh ring = latheMesh(square, 24, 30);
    expectClosed(ring);
    EXPECT_EQ(ring.mesh.points.size(), 4u * 24);
    EXPECT_NEAR(volume(ring.mesh), 12 * std::sin(2 * pi / 24) * (9 - 4), 1e-5);

    const std::vector<std::array<double, 2>> cone{{0, 0}, {1, 0}, {0, 2}};
    expectClosed(latheMesh(cone, 3, 0));
}

TEST(SurfaceMesh, RectanglesFaceUp) {
    const SurfaceMesh mesh = rectangleMesh(4, 2);
    EXPECT_EQ(boundsOf(mesh.mesh), (Box3d{{-2, 0, -1}, {2, 0, 1}}));
    for (std::size_t t = 0; t < 2; ++t) {
        const auto& [a, b, c] = mesh.mesh.triangles[t];
        const auto& p = mesh.mesh.points;
        EXPECT_GT(cross(p[b] - p[a], p[c] - p[a]).y, 0);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3f& q = p[mesh.mesh.triangles[t][k]];
            EXPECT_EQ(mesh.uvs[t][k], (Vec2f{(q.x + 2) / 4, (1 - q.z) / 2}));
        }
    }
    EXPECT_EQ(checkClosed(mesh.mesh).problem.substr(0, 28), "4 open edges, the first one ");
}

TEST(SurfaceMesh, LathesThatCannotBeAreErrors) {
    const std::vector<std::array<double, 2>> good{{0, 0}, {1, 0}}, bad{{0, 0}, {-1, 0}};
    expectError(ErrorKind::Usage, "a lathe of 2 segments", [&] { latheMesh(good, 2, 0); });
    expectError(ErrorKind::Usage, "point 1 of a lathe's profile is (-1, 0)",
                [&] { latheMesh(bad, 8, 0); });
    expectError(ErrorKind::Usage, "has 1 points",
                [&] { latheMesh(std::span(good).first(1), 8, 0); });
}

TEST(SurfaceMesh, SmoothNormalsOfABallAreRadial) {
    const SurfaceMesh ball = latheMesh(circle(64), 128, 60);
    double worst = 1;
    for (std::size_t t = 0; t < ball.mesh.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3d p = ball.mesh.points[ball.mesh.triangles[t][k]].as<double>();
            worst = std::min(worst, dot(ball.normals[t][k].as<double>(), normalize(p)));
        }
    EXPECT_GT(worst, std::cos(0.3 * pi / 180));
}

TEST(SurfaceMesh, EdgesSharperThanTheAngleStay) {
    SurfaceMesh box = boxMesh({{0, 0, 0}, {1, 1, 1}});
    smoothNormals(box, 89);
    for (std::size_t t = 0; t < 12; ++t) {
        const auto& [a, b, c] = box.mesh.triangles[t];
        const auto& p = box.mesh.points;
        for (const Vec3f& n : box.normals[t]) EXPECT_EQ(n, cross(p[b] - p[a], p[c] - p[a]));
    }
    smoothNormals(box, 91);
    for (std::size_t t = 0; t < 12; ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3d p = box.mesh.points[box.mesh.triangles[t][k]].as<double>();
            const Vec3d out = normalize(p - Vec3d{0.5, 0.5, 0.5});
            EXPECT_NEAR(dot(box.normals[t][k].as<double>(), out), 1, 1e-6);  // three sides alike
        }
}

TEST(SurfaceMesh, WhatIsNotClosedIsNamed) {
    const TriangleMesh box = boxMesh({{0, 0, 0}, {1, 1, 1}}).mesh;
    const auto problem = [](const TriangleMesh& mesh) {
        const Closedness closed = checkClosed(mesh);
        EXPECT_FALSE(closed.closed);
        return closed.problem;
    };
    TriangleMesh open = box;
    open.triangles.erase(open.triangles.begin());
    EXPECT_NE(problem(open).find("3 open edges, the first one at (0, 0, 0.5)"), std::string::npos)
        << problem(open);
    TriangleMesh turned = box;
    std::swap(turned.triangles[0][1], turned.triangles[0][2]);
    EXPECT_NE(problem(turned).find("3 edges between triangles that face opposite ways, the first"),
              std::string::npos)
        << problem(turned);
    TriangleMesh wall = box;  // one from edge to edge inside
    wall.triangles.push_back({0, 1, 7});
    EXPECT_NE(problem(wall).find("edges of more than two triangles"), std::string::npos)
        << problem(wall);
    EXPECT_EQ(problem({}), "it encloses no volume");
    TriangleMesh flat{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{{0, 1, 2}}, {{0, 2, 1}}}};
    EXPECT_EQ(problem(flat), "it encloses no volume");
}

TEST(SurfaceMesh, FlippedMeshesFaceInwards) {
    SurfaceMesh ball = latheMesh(circle(8), 16, 60);
    const SurfaceMesh before = ball;
    flip(ball);
    EXPECT_TRUE(checkClosed(ball.mesh).closed);
    EXPECT_TRUE(checkClosed(ball.mesh).inwards);
    EXPECT_EQ(ball.normals[5][1], -before.normals[5][2]);
    EXPECT_EQ(ball.uvs[5][1], before.uvs[5][2]);
    flip(ball);
    EXPECT_EQ(ball.mesh.triangles, before.mesh.triangles);
    EXPECT_EQ(ball.normals, before.normals);
}

const std::string objText =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    "vt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nvn 0 0 2\nvn 0 0.6 0.8\n"
    "f 1/1/1 2/2/1 3/3/2 4/4/2\n";

void expectSquare(const SurfaceMesh& mesh) {
    EXPECT_EQ(mesh.mesh.points.size(), 4u);
    ASSERT_EQ(mesh.mesh.triangles.size(), 2u);
    ASSERT_EQ(mesh.normals.size(), 2u);
    ASSERT_EQ(mesh.uvs.size(), 2u);
    for (std::size_t t = 0; t < 2; ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3f p = mesh.mesh.points[mesh.mesh.triangles[t][k]];
            EXPECT_EQ(mesh.uvs[t][k], (Vec2f{p.x / 2, p.y}));
            const Vec3d n = p.y == 0 ? Vec3d{0, 0, 1} : Vec3d{0, 0.6, 0.8};
            EXPECT_LT(length(mesh.normals[t][k].as<double>() - n), 1e-6);
        }
}

TEST(SurfaceMeshRead, NormalsAndTextureCoordinatesOfAnObj) {
    NEEDS_ASSIMP();
    const TempDir dir;
    writeText(dir / "a.obj", objText);
    expectSquare(readSurfaceMesh(dir / "a.obj"));
}

TEST(SurfaceMeshRead, NormalsAndTextureCoordinatesOfAPly) {
    const TempDir dir;
    std::string header = "ply\nformat ascii 1.0\nelement vertex 4\n";
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "s", "t"})
        header += fmt::format("property float {}\n", name);
    writeText(dir / "a.ply",
              header +
                  "element face 1\nproperty list uchar int vertex_index\nend_header\n"
                  "0 0 0 0 0 2 0 0\n1 0 0 0 0 2 0.5 0\n1 1 0 0 3 4 0.5 1\n"
                  "0 1 0 0 3 4 0 1\n4 0 1 2 3\n");
    expectSquare(readSurfaceMesh(dir / "a.ply"));
}

TEST(SurfaceMeshRead, TrianglesOfNoAreaAreLeftOutAndCounted) {
    NEEDS_ASSIMP();
    const TempDir dir;
    writeText(dir / "a.obj", objText + "v 2 0 0\nf 1 2 5\nf 1 1 2\n");
    const SurfaceMesh mesh = readSurfaceMesh(dir / "a.obj");
    EXPECT_EQ(mesh.mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.normals.size(), 2u);
    EXPECT_EQ(mesh.droppedTriangles, 2u);
    writeText(dir / "flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    expectError(ErrorKind::Input, "holds no triangles but 1 of no area",
                [&] { readSurfaceMesh(dir / "flat.obj"); });
    writeText(dir / "nan.obj", "v 0 0 0\nv 1 0 nan\nv 0 inf 0\nf 1 2 3\n");
    expectError(ErrorKind::Input, "2 points that are not finite, the first is 1",
                [&] { readSurfaceMesh(dir / "nan.obj"); });
    expectError(ErrorKind::Input, "no such file", [&] { readSurfaceMesh(dir / "missing.obj"); });
}

/// Bits flipped and ends cut off: a mesh that is whole, or an error.
TEST(SurfaceMeshRead, DamagedFilesDoNoHarm) {
    NEEDS_ASSIMP();
    const TempDir dir;
    RandomStream random(9);
    int errors = 0, meshes = 0;
    for (int variant = 0; variant < 300; ++variant) {
        std::string bytes = objText;
        if (variant % 3 == 0) bytes.resize(random.bits() % bytes.size());
        for (int i = 0; i < variant % 4 && !bytes.empty(); ++i)
            bytes[random.bits() % bytes.size()] ^= static_cast<char>(1 << random.bits() % 8);
        writeText(dir / "a.obj", bytes);
        try {
            const SurfaceMesh mesh = readSurfaceMesh(dir / "a.obj");
            for (const auto& triangle : mesh.mesh.triangles)
                for (std::uint32_t i : triangle) ASSERT_LT(i, mesh.mesh.points.size());
            for (const std::size_t size : {mesh.uvs.size(), mesh.normals.size()})
                ASSERT_TRUE(size == 0 || size == mesh.mesh.triangles.size());
            for (const auto& normals : mesh.normals)
                for (const Vec3f& n : normals) ASSERT_NEAR(length(n.as<double>()), 1, 1e-5);
            ++meshes;
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find("a.obj"), std::string::npos) << e.what();
            ++errors;
        }
    }
    EXPECT_GT(errors, 50);
    EXPECT_GT(meshes, 50);
}

}  // namespace
}  // namespace woodcock::test
