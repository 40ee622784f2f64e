// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "woodcock/base/error.h"
#include "woodcock/mesh/surface_mesh.h"

namespace woodcock::mesh {

SurfaceMesh boxMesh(const Box3d& box) {
    SurfaceMesh mesh;
    for (int i = 0; i < 8; ++i) mesh.mesh.points.push_back(box.corner(i).as<float>());
    // Corners count up along x, then y, then z; each side counter-clockwise from outside.
    constexpr std::array<std::array<std::uint32_t, 4>, 6> sides{
        {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
    constexpr Vec2f a{0, 0}, b{1, 0}, c{1, 1}, d{0, 1};
    for (const auto& side : sides) {
        mesh.mesh.triangles.push_back({side[0], side[1], side[2]});
        mesh.mesh.triangles.push_back({side[0], side[2], side[3]});
        mesh.uvs.push_back({a, b, c});
        mesh.uvs.push_back({a, c, d});
    }
    return mesh;
}

SurfaceMesh rectangleMesh(double width, double depth) {
    const auto x = static_cast<float>(width / 2), z = static_cast<float>(depth / 2);
    SurfaceMesh mesh;
    mesh.mesh.points = {{-x, 0, z}, {x, 0, z}, {x, 0, -z}, {-x, 0, -z}};
    mesh.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    constexpr Vec2f a{0, 0}, b{1, 0}, c{1, 1}, d{0, 1};
    mesh.uvs = {{a, b, c}, {a, c, d}};
    return mesh;
}

namespace {

/// The points of a profile, turned about y: one on the axis, else one for each segment.
class Rings {
public:
    Rings(std::span<const std::array<double, 2>> profile, int segments, TriangleMesh& mesh)
        : segments_(static_cast<std::uint32_t>(segments)) {
        for (const auto& [radius, height] : profile) {
            first_.push_back(static_cast<std::uint32_t>(mesh.points.size()));
            onAxis_.push_back(radius == 0);
            for (std::uint32_t s = 0; s < (radius == 0 ? 1 : segments_); ++s) {
                const double angle = 2 * pi * s / segments_;
                mesh.points.push_back(
                    Vec3d{radius * std::cos(angle), height, -radius * std::sin(angle)}.as<float>());
            }
        }
    }
    bool onAxis(std::size_t ring) const { return onAxis_[ring]; }
    std::uint32_t at(std::size_t ring, std::uint32_t segment) const {
        return first_[ring] + (onAxis_[ring] ? 0 : segment % segments_);
    }

private:
    std::uint32_t segments_;
    std::vector<std::uint32_t> first_;
    std::vector<bool> onAxis_;
};

}  // namespace

SurfaceMesh latheMesh(std::span<const std::array<double, 2>> profile, int segments,
                      double smoothAngle) {
    if (segments < 3) throw usageError("a lathe of {} segments; at least 3 are needed", segments);
    if (profile.size() < 2)
        throw usageError("a lathe whose profile has {} points; at least 2 are needed",
                         profile.size());
    for (std::size_t i = 0; i < profile.size(); ++i)
        if (!(profile[i][0] >= 0) || !std::isfinite(profile[i][0]) || !std::isfinite(profile[i][1]))
            throw usageError(
                "point {} of a lathe's profile is ({}, {}); expected a radius of 0 or more, and a "
                "height",
                i, profile[i][0], profile[i][1]);

    SurfaceMesh mesh;
    const bool ring = profile.front() == profile.back() && profile.size() > 3;
    const Rings rings(ring ? profile.first(profile.size() - 1) : profile, segments, mesh.mesh);
    const auto steps = profile.size() - 1;
    const auto turns = static_cast<std::uint32_t>(segments);
    for (std::size_t i = 0; i < steps; ++i) {
        const std::size_t next = ring && i + 1 == steps ? 0 : i + 1;
        if (rings.onAxis(i) && rings.onAxis(next)) continue;
        for (std::uint32_t s = 0; s < turns; ++s) {
            const auto uv = [&](std::uint32_t turn, std::size_t step) {
                return Vec2f{static_cast<float>(turn) / static_cast<float>(turns),
                             static_cast<float>(step) / static_cast<float>(steps)};
            };
            const std::uint32_t a = rings.at(i, s), b = rings.at(i, s + 1);
            const std::uint32_t c = rings.at(next, s + 1), d = rings.at(next, s);
            if (!rings.onAxis(i)) {
                mesh.mesh.triangles.push_back({a, b, c});
                mesh.uvs.push_back({uv(s, i), uv(s + 1, i), uv(s + 1, i + 1)});
            }
            if (!rings.onAxis(next)) {
                mesh.mesh.triangles.push_back({a, c, d});
                mesh.uvs.push_back({uv(s, i), uv(s + 1, i + 1), uv(s, i + 1)});
            }
        }
    }
    smoothNormals(mesh, smoothAngle);
    return mesh;
}

namespace {

Vec3f toFloat(Vec3d p) { return p.as<float>(); }
float share(int i, int of) { return static_cast<float>(i) / static_cast<float>(of); }

double areaOf(const TriangleMesh& mesh) {
    double area = 0;
    for (const auto& t : mesh.triangles) {
        const Vec3d a = mesh.points[t[0]].as<double>(), b = mesh.points[t[1]].as<double>(),
                    c = mesh.points[t[2]].as<double>();
        area += length(cross(b - a, c - a)) / 2;
    }
    return area;
}

void scaleToArea(TriangleMesh& mesh, double area) {
    const double scale = std::sqrt(area / areaOf(mesh));
    for (Vec3f& p : mesh.points) p = toFloat(p.as<double>() * scale);
}

}  // namespace

SurfaceMesh sphereMesh(int rings) {
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
    SurfaceMesh sphere;
    sphere.mesh.points = {{0, -1, 0}, {0, 1, 0}};
    for (int ring = 1; ring < rings; ++ring)
        for (int sector = 0; sector < sectors; ++sector)
            sphere.mesh.points.push_back(toFloat(at(ring, sector)));
    using Corner = std::array<int, 2>;  // ring, sector
    const auto add = [&](Corner a, Corner b, Corner c) {
        std::array<std::uint32_t, 3> triangle;
        std::array<Vec3f, 3> normals;
        std::array<Vec2f, 3> uvs;
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

SurfaceMesh diskMesh(int sectors) {
    SurfaceMesh disk;
    disk.mesh.points = {{0, 0, 0}};
    for (int i = 0; i < sectors; ++i) {
        const double angle = 2 * pi * i / sectors;
        disk.mesh.points.push_back(toFloat({std::cos(angle), 0, -std::sin(angle)}));
        const int next = (i + 1) % sectors;
        disk.mesh.triangles.push_back(
            {0, static_cast<std::uint32_t>(1 + i), static_cast<std::uint32_t>(1 + next)});
    }
    const auto uv = [&](std::uint32_t i) -> Vec2f {
        const Vec3f p = disk.mesh.points[i];
        return {(1 + p.x) / 2, (1 - p.z) / 2};
    };
    for (const auto& t : disk.mesh.triangles) disk.uvs.push_back({uv(t[0]), uv(t[1]), uv(t[2])});
    scaleToArea(disk.mesh, pi);
    return disk;
}

}  // namespace woodcock::mesh
