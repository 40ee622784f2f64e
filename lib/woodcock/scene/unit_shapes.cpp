// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/unit_shapes.h"

#include <cmath>

namespace woodcock::scene {
namespace {

Vec3f toFloat(Vec3d p) { return p.as<float>(); }
float share(int i, int of) { return static_cast<float>(i) / static_cast<float>(of); }

double areaOf(const mesh::TriangleMesh& mesh) {
    double area = 0;
    for (const auto& t : mesh.triangles) {
        const Vec3d a = mesh.points[t[0]].as<double>(), b = mesh.points[t[1]].as<double>(),
                    c = mesh.points[t[2]].as<double>();
        area += length(cross(b - a, c - a)) / 2;
    }
    return area;
}

void scaleToArea(mesh::TriangleMesh& mesh, double area) {
    const double scale = std::sqrt(area / areaOf(mesh));
    for (Vec3f& p : mesh.points) p = toFloat(p.as<double>() * scale);
}

}  // namespace

mesh::SurfaceMesh sphereMesh(int rings) {
    const int sectors = 2 * rings;
    // A ring's points lie at the same latitude; the first and the last ring are the poles.
    const auto at = [&](int ring, int sector) -> Vec3d {
        const double latitude = pi * ring / rings - pi / 2, longitude = 2 * pi * sector / sectors;
        return {std::cos(latitude) * std::cos(longitude), std::sin(latitude),
                -std::cos(latitude) * std::sin(longitude)};
    };
    const auto index = [&](int ring, int sector) {
        if (ring == 0) return std::uint32_t{0};
        if (ring == rings) return std::uint32_t{1};
        return static_cast<std::uint32_t>(2 + (ring - 1) * sectors + sector % sectors);
    };
    mesh::SurfaceMesh sphere;
    sphere.mesh.points = {{0, -1, 0}, {0, 1, 0}};
    for (int ring = 1; ring < rings; ++ring)
        for (int sector = 0; sector < sectors; ++sector)
            sphere.mesh.points.push_back(toFloat(at(ring, sector)));
    using Corner = std::array<int, 2>;  // ring, sector
    const auto add = [&](Corner a, Corner b, Corner c) {
        std::array<std::uint32_t, 3> triangle;
        std::array<Vec3f, 3> normals;
        std::array<mesh::Vec2f, 3> uvs;
        for (size_t i = 0; const auto& [ring, sector] : {a, b, c}) {
            triangle[i] = index(ring, sector);
            normals[i] = toFloat(at(ring, sector));
            uvs[i++] = {share(sector, sectors), share(ring, rings)};
        }
        sphere.mesh.triangles.push_back(triangle);
        sphere.normals.push_back(normals);
        sphere.uvs.push_back(uvs);
    };
    for (int ring = 0; ring < rings; ++ring)
        for (int s = 0; s < sectors; ++s) {
            if (ring > 0) add({ring, s}, {ring, s + 1}, {ring + 1, s + 1});
            if (ring + 1 < rings) add({ring, s}, {ring + 1, s + 1}, {ring + 1, s});
        }
    scaleToArea(sphere.mesh, 4 * pi);
    return sphere;
}

mesh::SurfaceMesh diskMesh(int sectors) {
    mesh::SurfaceMesh disk;
    disk.mesh.points = {{0, 0, 0}};
    for (int i = 0; i < sectors; ++i) {
        const double angle = 2 * pi * i / sectors;
        disk.mesh.points.push_back(toFloat({std::cos(angle), 0, -std::sin(angle)}));
        const int next = (i + 1) % sectors;
        disk.mesh.triangles.push_back(
            {0, static_cast<std::uint32_t>(1 + i), static_cast<std::uint32_t>(1 + next)});
    }
    const auto uv = [&](std::uint32_t i) -> mesh::Vec2f {
        const Vec3f p = disk.mesh.points[i];
        return {(1 + p.x) / 2, (1 - p.z) / 2};
    };
    for (const auto& t : disk.mesh.triangles) disk.uvs.push_back({uv(t[0]), uv(t[1]), uv(t[2])});
    scaleToArea(disk.mesh, pi);
    return disk;
}

}  // namespace woodcock::scene
