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

}  // namespace woodcock::mesh
