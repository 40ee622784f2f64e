// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>

#include "woodcock/mesh/triangle_mesh.h"

namespace woodcock::test {

enum class Facing { Outwards, Inwards };

/// The box as 12 triangles of 8 points.
inline mesh::TriangleMesh boxOf(const Box3d& box, Facing facing = Facing::Outwards) {
    mesh::TriangleMesh mesh;
    for (int i = 0; i < 8; ++i) mesh.points.push_back(box.corner(i).as<float>());
    constexpr std::array<std::array<std::uint32_t, 4>, 6> sides{
        {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
    for (const auto& [a, b, c, d] : sides) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    }
    if (facing == Facing::Inwards)
        for (auto& [a, b, c] : mesh.triangles) std::swap(b, c);
    return mesh;
}

/// A cube about `centre`.
inline mesh::TriangleMesh cubeOf(double halfSide, Facing facing = Facing::Outwards,
                                 Vec3d centre = {}) {
    const Vec3d half = Vec3d{1, 1, 1} * halfSide;
    return boxOf({centre - half, centre + half}, facing);
}

inline mesh::TriangleMesh together(std::initializer_list<mesh::TriangleMesh> parts) {
    mesh::TriangleMesh all;
    for (const mesh::TriangleMesh& part : parts) {
        const auto first = static_cast<std::uint32_t>(all.points.size());
        all.points.insert(all.points.end(), part.points.begin(), part.points.end());
        for (const auto& [a, b, c] : part.triangles)
            all.triangles.push_back({first + a, first + b, first + c});
    }
    return all;
}

}  // namespace woodcock::test
