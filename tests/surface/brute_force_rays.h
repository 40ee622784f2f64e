// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <variant>
#include <vector>

#include "woodcock/base/random.h"
#include "woodcock/surface/geometry.h"

namespace woodcock::test {

inline Vec3d randomDirection(RandomStream& random) {
    const double z = 2 * random.uniform() - 1, phi = 2 * pi * random.uniform();
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

inline Vec3d randomPoint(RandomStream& random, double half) {
    const auto one = [&] { return half * (2 * random.uniform() - 1); };
    return {one(), one(), one()};
}

/// A rotation with scales of either sign, and a place.
inline Affine3d randomTransform(RandomStream& random, double scale, double distance) {
    const auto size = [&] {
        return scale * (0.3 + random.uniform()) * (random.uniform() < 0.3 ? -1 : 1);
    };
    return Affine3d::translate(randomPoint(random, distance)) *
           Affine3d::rotate(0, 360 * random.uniform()) *
           Affine3d::rotate(1, 360 * random.uniform()) * Affine3d::scale({size(), size(), size()});
}

struct OracleHit {
    double t = std::numeric_limits<double>::infinity();
    std::uint32_t instance = 0, primitive = 0;
    Vec3d normal;                                               ///< world space
    double b1 = 0, b2 = 0;                                      ///< of triangles
    double nearEdge = std::numeric_limits<double>::infinity();  ///< least |barycentric| of all
};

/// All primitives against the ray, triangles in world space. Written apart from the library's.
inline OracleHit bruteForce(const surface::Geometry& geometry, Vec3d o, Vec3d d) {
    OracleHit best;
    const auto offer = [&](double t, std::uint32_t i, std::uint32_t primitive, Vec3d normal,
                           double b1, double b2) {
        if (t > 0 && t < best.t) {
            const double edge = best.nearEdge;
            best = {t, i, primitive, normal * (1 / length(normal)), b1, b2, edge};
        }
    };
    for (std::uint32_t i = 0; i < geometry.instances().size(); ++i) {
        const surface::ShapeInstance& instance = geometry.instances()[i];
        const Affine3d& m = instance.worldFromObject;
        const Affine3d inverse = m.inverse();
        const Vec3d oo = inverse.point(o), od = inverse.vector(d);
        const auto normalOf = [&](Vec3d n) {  // transpose of the inverse
            return Vec3d{dot(inverse.column[0], n), dot(inverse.column[1], n),
                         dot(inverse.column[2], n)};
        };
        const surface::Shape& shape = geometry.shapes()[instance.shape];
        if (std::holds_alternative<surface::UnitSphere>(shape)) {
            const double a = dot(od, od), b = dot(oo, od), c = dot(oo, oo) - 1;
            const double root = std::sqrt(b * b - a * c);
            for (const double t : {(-b - root) / a, (-b + root) / a})
                offer(t, i, 0, normalOf(oo + od * t), 0, 0);
        } else if (const auto* mesh =
                       std::get_if<std::shared_ptr<const mesh::SurfaceMesh>>(&shape)) {
            for (std::uint32_t p = 0; p < (*mesh)->mesh.triangles.size(); ++p) {
                const auto& t = (*mesh)->mesh.triangles[p];
                const auto corner = [&](std::size_t k) {
                    return m.point((*mesh)->mesh.points[t[k]].as<double>());
                };
                const Vec3d e1 = corner(1) - corner(0), e2 = corner(2) - corner(0);
                const Vec3d s = cross(d, e2);
                const double f = 1 / dot(s, e1);
                const Vec3d v = o - corner(0), q = cross(v, e1);
                const double b1 = f * dot(s, v), b2 = f * dot(d, q), at = f * dot(e2, q);
                const double edge = std::min({b1, b2, 1 - b1 - b2});
                if (at > 0) best.nearEdge = std::min(best.nearEdge, std::abs(edge));
                const Vec3d n = cross(e1, e2) * (m.determinant() < 0 ? -1.0 : 1.0);
                if (edge >= 0) offer(at, i, p, n, b1, b2);
            }
        } else {
            const double t = -oo.y / od.y;
            const Vec3d p = oo + od * t;
            const bool disk = std::holds_alternative<surface::UnitDisk>(shape);
            if (!disk || p.x * p.x + p.z * p.z <= 1) offer(t, i, 0, normalOf({0, 1, 0}), 0, 0);
        }
    }
    return best;
}

}  // namespace woodcock::test
