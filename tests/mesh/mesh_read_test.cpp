// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstring>
#include <filesystem>
#include <string>

#include "tests/support/expect_error.h"
#include "tests/support/mesh_volume.h"
#include "woodcock/base/random.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/mesh/triangle_mesh.h"

namespace woodcock::test {

using namespace mesh;
namespace {

#define NEEDS_ASSIMP() \
    if (!canReadMeshes()) GTEST_SKIP() << "this build has no Assimp"

/// A unit cube of six squares, outside to the outside.
const std::string cubeObj =
    "mtllib nowhere.mtl\n"
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "usemtl none\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

void expectUnitCube(const TriangleMesh& mesh) {
    EXPECT_EQ(mesh.points.size(), 8u);
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_EQ(boundsOf(mesh), (Box3d{{0, 0, 0}, {1, 1, 1}}));
    EXPECT_EQ(volume(mesh), 1);
    EXPECT_EQ(findOpenEdges(mesh).count, 0u);
}

/// As STL: each triangle has corners of its own, and the file says nothing of shared ones.
std::string asciiStl(const TriangleMesh& mesh) {
    std::string text = "solid cube\n";
    for (const auto& triangle : mesh.triangles) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (std::uint32_t i : triangle) {
            const Vec3f& p = mesh.points[i];
            text += fmt::format("vertex {} {} {}\n", p.x, p.y, p.z);
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid cube\n";
}

template <class T>
void append(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string binaryStl(const TriangleMesh& mesh) {
    std::string bytes(80, ' ');
    append(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const auto& triangle : mesh.triangles) {
        for (int i = 0; i < 3; ++i) append(bytes, 0.0f);
        for (std::uint32_t i : triangle)
            for (int axis = 0; axis < 3; ++axis) append(bytes, mesh.points[i][axis]);
        append(bytes, std::uint16_t{0});
    }
    return bytes;
}

std::string binaryPly(const TriangleMesh& mesh) {
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
        "property float y\nproperty float z\nelement face {}\n"
        "property list uchar int vertex_indices\nend_header\n",
        mesh.points.size(), mesh.triangles.size());
    for (const Vec3f& p : mesh.points)
        for (int axis = 0; axis < 3; ++axis) append(bytes, p[axis]);
    for (const auto& triangle : mesh.triangles) {
        append(bytes, std::uint8_t{3});
        for (std::uint32_t i : triangle) append(bytes, i);
    }
    return bytes;
}

const std::string plyFaces = "property list uchar int vertex_index\n";

/// Three points, and what follows them in the header and in the body.
std::string plyText(const std::string& header, const std::string& body) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
           "property float z\n" +
           header + "end_header\n0 0 0\n1 0 0\n0 1 0\n" + body + "\n";
}

/// One triangle (0,0,0), (1,0,0), (0,1,0) in `buffer`, which two nodes place.
std::string gltf(const std::string& buffer) {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"translation":[10,0,0],"mesh":0,"children":[1]},{"scale":[2,2,2],"translation":[0,5,0],"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],
"buffers":[{"byteLength":42,"uri":")" +
           buffer + "\"}]}";
}

std::string gltfBuffer() {
    std::string bytes;
    for (float v : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) append(bytes, v);
    for (std::uint16_t i = 0; i < 3; ++i) append(bytes, i);
    return bytes;
}

TriangleMesh cube() {
    const TempDir dir;
    writeText(dir / "cube.obj", cubeObj);
    return readMesh(dir / "cube.obj");
}

TEST(MeshRead, FacesOfAnObjBecomeTrianglesThoughItsMaterialsAreMissing) {
    NEEDS_ASSIMP();
    expectUnitCube(cube());
}

TEST(MeshRead, StlAndPlyAreTheSameMesh) {
    NEEDS_ASSIMP();
    const TempDir dir;
    writeText(dir / "ascii.stl", asciiStl(cube()));
    writeText(dir / "binary.STL", binaryStl(cube()));
    writeText(dir / "binary.ply", binaryPly(cube()));
    for (const char* name : {"ascii.stl", "binary.STL", "binary.ply"})
        expectUnitCube(readMesh(dir / name));
}

TEST(MeshRead, PolygonsOfAPlyAreReadWithoutAssimp) {
    const TempDir dir;
    writeText(dir / "a.ply",
              "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\n"
              "property double y\nproperty double z\nelement face 1\n" +
                  plyFaces + "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 3 2 1 0\n");
    const TriangleMesh mesh = readMesh(dir / "a.ply");
    EXPECT_EQ(mesh.points.size(), 4u);
    ASSERT_EQ(mesh.triangles.size(), 2u);
    for (const auto& [a, b, c] : mesh.triangles)  // clockwise, as the file has it
        EXPECT_LT(cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]).z, 0);
}

TEST(MeshRead, NodesPlaceTheirParts) {
    NEEDS_ASSIMP();
    const TempDir dir;
    writeText(dir / "a.gltf", gltf("a.bin"));
    writeText(dir / "a.bin", gltfBuffer());
    const TriangleMesh mesh = readMesh(dir / "a.gltf");
    ASSERT_EQ(mesh.triangles.size(), 2u);
    const std::vector<Vec3f> expected{{10, 0, 0}, {11, 0, 0}, {10, 1, 0},
                                      {10, 5, 0}, {12, 5, 0}, {10, 7, 0}};
    EXPECT_EQ(mesh.points, expected);
}

TEST(MeshRead, ACubeWithoutLidIsOpenAtFourEdges) {
    NEEDS_ASSIMP();
    const TempDir dir;
    const std::string lid = "f 5 6 7 8\n";
    std::string text = cubeObj;
    writeText(dir / "open.obj", text.erase(text.find(lid), lid.size()));
    const OpenEdges open = findOpenEdges(readMesh(dir / "open.obj"));
    EXPECT_EQ(open.count, 4u);
    EXPECT_EQ(open.first.z, 1);
}

TEST(MeshRead, WeldDropsWhatLosesACorner) {
    const TriangleMesh mesh = weld({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0f, 0, 0}},
                                    {{{0, 1, 2}}, {{0, 3, 1}}, {{3, 2, 1}}}});
    EXPECT_EQ(mesh.points.size(), 3u);
    EXPECT_EQ(mesh.triangles,
              (std::vector<std::array<std::uint32_t, 3>>{{{0, 1, 2}}, {{0, 2, 1}}}));
}

/// Coordinates of a map, with millimetres: floats are half a metre apart there.
TEST(MeshRead, FarMeshesKeepTheirDigits) {
    NEEDS_ASSIMP();
    const Vec3d far{512345.125, -5412345.25, 6371000.375};
    const TriangleMesh near = cube();
    const auto place = [&](std::uint32_t i) { return far + near.points[i].as<double>() * 0.125; };
    const TempDir dir;
    std::string obj = "o far\n", stl = "solid far\n";
    for (std::uint32_t i = 0; i < near.points.size(); ++i)
        obj += fmt::format("v {:.3f} {:.3f} +{:.3f}{}\r\n", place(i).x, place(i).y, place(i).z,
                           i % 2 ? " 1.0" : "");
    std::string ply = fmt::format(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\n"
        "property double z\nelement face {}\n{}end_header\n",
        near.points.size(), near.triangles.size(), plyFaces);
    for (std::uint32_t i = 0; i < near.points.size(); ++i)
        ply += fmt::format("{:.3f} {:.3f} {:.3f}\n", place(i).x, place(i).y, place(i).z);
    for (const auto& [a, b, c] : near.triangles) {
        obj += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
        ply += fmt::format("3 {} {} {}\n", a, b, c);
        stl += " facet normal 0 0 0\n  outer loop\n";
        for (const std::uint32_t i : {a, b, c})
            stl +=
                fmt::format("   vertex {:.3f} {:.3f} {:.3f}\n", place(i).x, place(i).y, place(i).z);
        stl += "  endloop\n endfacet\n";
    }
    writeText(dir / "far.obj", obj);
    writeText(dir / "far.stl", stl + "endsolid far\n");
    writeText(dir / "far.ply", ply);
    for (const char* name : {"far.obj", "far.stl", "far.ply"}) {
        const TriangleMesh mesh = readMesh(dir / name);
        EXPECT_EQ(mesh.points.size(), 8u) << name;
        EXPECT_EQ(mesh.triangles.size(), 12u) << name;
        const Box3d box = boundsOf(mesh);
        EXPECT_EQ(mesh.origin + box.lower, far) << name;
        EXPECT_EQ(mesh.origin + box.upper, (far + Vec3d{0.125, 0.125, 0.125})) << name;
        EXPECT_NEAR(volume(mesh), 0.125 * 0.125 * 0.125, 1e-9) << name;
    }
    EXPECT_EQ(near.origin, Vec3d{});
}

/// A node far away: the shape keeps its digits, and its place those of a float.
TEST(MeshRead, FarNodesKeepTheShapeOfTheirParts) {
    NEEDS_ASSIMP();
    const TempDir dir;
    std::string text = gltf("a.bin");
    text.replace(text.find("[10,0,0]"), 8, "[4194304.5,0,-5412345.5]");
    writeText(dir / "a.gltf", text);
    writeText(dir / "a.bin", gltfBuffer());
    const TriangleMesh mesh = readMesh(dir / "a.gltf");
    ASSERT_EQ(mesh.points.size(), 6u);
    EXPECT_EQ(mesh.origin + mesh.points[0].as<double>(), (Vec3d{4194304.5, 0, -5412345.5}));
    EXPECT_EQ((mesh.points[1] - mesh.points[0]), (Vec3f{1, 0, 0}));
    EXPECT_EQ((mesh.points[4] - mesh.points[3]), (Vec3f{2, 0, 0}));
}

TEST(MeshRead, BadFilesAreErrorsThatNameThem) {
    NEEDS_ASSIMP();
    const TempDir dir;
    const auto expectBad = [&](const char* name, const std::string& text, const char* part) {
        writeText(dir / name, text);
        expectError(ErrorKind::Input, part, [&] { readMesh(dir / name); });
        expectError(ErrorKind::Input, name, [&] { readMesh(dir / name); });
    };
    expectBad("words.fbx", "words", "ends in '.fbx'; expected .obj, .ply, .stl, .gltf or .glb");
    expectBad("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "");
    expectBad("lines.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nl 2 3\n", "holds no triangles");
    expectBad("flat.obj", "v 0 0 0\nv 1 0 0\nf 1 2 2\n", "holds no triangles");
    expectBad("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "");
    expectBad("nan.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n", "1 points that are not finite");
    expectBad("empty.ply", "", "is not a PLY file");
    expectBad("words.ply", "These are words.\n", "is not a PLY file");
    expectBad("points.ply", plyText("", "0"), "has no element 'face'");
    expectBad("lines.ply", plyText("element face 1\n" + plyFaces, "2 0 1"), "no triangles");
    expectBad("index.ply", plyText("element face 1\n" + plyFaces, "3 0 1 3"),
              "face 0 refers to point 3 of 3");
    expectBad("sign.ply", plyText("element face 1\n" + plyFaces, "3 0 1 -1"),
              "face 0 refers to point -1 of 3");
    expectBad("names.ply", plyText("element face 1\nproperty list uchar int corners\n", "3 0 1 2"),
              "element 'face' has no list 'vertex_indices'");
    expectBad("words.gltf", "{\"asset\":", "cannot read mesh");
    expectBad("buffer.gltf", gltf("missing.bin"), "cannot read mesh");
    std::string lies = binaryStl(cube());
    lies[83] = '\x70';  // two thousand million triangles
    expectBad("lies.stl", lies, "cannot read mesh");
    std::filesystem::create_directory(dir / "directory.obj");
    expectError(ErrorKind::Input, "not a regular file", [&] { readMesh(dir / "directory.obj"); });
    expectError(ErrorKind::Input, "no such file", [&] { readMesh(dir / "missing.obj"); });
}

TEST(MeshRead, APipeInPlaceOfABufferIsNotWaitedFor) {
    NEEDS_ASSIMP();
    const TempDir dir;
    writeText(dir / "a.gltf", gltf("pipe.bin"));
    ASSERT_EQ(mkfifo((dir / "pipe.bin").c_str(), 0600), 0);
    expectError(ErrorKind::Input, "cannot read mesh", [&] { readMesh(dir / "a.gltf"); });
}

/// Bits flipped and ends cut off: a mesh or an error, and indices that fit.
TEST(MeshRead, DamagedFilesDoNoHarm) {
    NEEDS_ASSIMP();
    const TempDir dir;
    writeText(dir / "a.bin", gltfBuffer());
    const std::pair<const char*, std::string> samples[]{
        {"a.obj", cubeObj},           {"a.stl", asciiStl(cube())},
        {"b.stl", binaryStl(cube())}, {"a.ply", plyText("element face 1\n" + plyFaces, "3 0 1 2")},
        {"b.ply", binaryPly(cube())}, {"a.gltf", gltf("a.bin")}};
    RandomStream random(7);
    int errors = 0, meshes = 0;
    for (int variant = 0; variant < 300; ++variant)
        for (const auto& [name, healthy] : samples) {
            std::string bytes = healthy;
            const auto place = [&] { return random.bits() % bytes.size(); };
            if (variant % 3 == 0) bytes.resize(place());
            if (variant % 3 != 0 && !bytes.empty())
                for (int i = 0; i < 1 + variant % 5; ++i)
                    bytes[place()] ^= static_cast<char>(1 << random.bits() % 8);
            writeText(dir / name, bytes);
            try {
                const TriangleMesh mesh = readMesh(dir / name);
                for (const auto& triangle : mesh.triangles)
                    for (std::uint32_t i : triangle) ASSERT_LT(i, mesh.points.size());
                ++meshes;
            } catch (const Error& e) {
                EXPECT_NE(std::string(e.what()).find(name), std::string::npos) << e.what();
                ++errors;
            }
        }
    EXPECT_GT(errors, 100);
    EXPECT_GT(meshes, 100);
}

TEST(MeshRead, GltfThatNestsWithoutEndIsRefused) {
    NEEDS_ASSIMP();
    const TempDir dir;
    const auto refused = [&](const std::string& scene, const char* why) {
        const std::string text = "{\"asset\": {\"version\": \"2.0\"}, " + scene + "}";
        writeText(dir / "a.gltf", text);
        std::string binary = "glTF";
        append(binary, std::uint32_t{2});
        append(binary, static_cast<std::uint32_t>(20 + text.size()));
        append(binary, static_cast<std::uint32_t>(text.size()));
        writeText(dir / "a.glb", binary + "JSON" + text);
        for (const char* name : {"a.gltf", "a.glb"})
            expectError(ErrorKind::Input, why, [&] { readMesh(dir / name); });
    };
    std::string open, close, chain;
    for (int i = 0; i < 100000; ++i) {
        open += '[', close += ']';
        chain += fmt::format("{{\"children\": [{}]}}, ", i + 1);
    }
    refused("\"extras\": " + open + close, "its JSON nests more than 200 levels deep");
    refused("\"scene\": 0, \"scenes\": [{\"nodes\": [0]}], \"nodes\": [" + chain + "{}]",
            "its nodes follow each other more than 200 levels deep");
    refused("\"scene\": 0, \"scenes\": [{\"nodes\": [0]}], \"nodes\": [" + chain +
                "{\"children\": [0]}]",
            "its nodes lead in a circle");
}

}  // namespace
}  // namespace woodcock::test
