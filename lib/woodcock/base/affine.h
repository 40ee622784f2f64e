// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "woodcock/base/vec.h"

namespace woodcock {

/// Affine map of 3-space: p -> L p + translation. L is stored by columns (the images of the axes).
struct Affine3d {
    std::array<Vec3d, 3> column{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
    Vec3d translation{};

    Vec3d vector(Vec3d v) const { return column[0] * v.x + column[1] * v.y + column[2] * v.z; }
    Vec3d point(Vec3d p) const { return vector(p) + translation; }
    double determinant() const { return dot(column[0], cross(column[1], column[2])); }
    bool operator==(const Affine3d&) const = default;

    /// The map that applies `first`, then this one.
    Affine3d operator*(const Affine3d& first) const {
        return {{vector(first.column[0]), vector(first.column[1]), vector(first.column[2])},
                point(first.translation)};
    }

    /// The inverse map; meaningless unless determinant() is a finite number other than zero.
    Affine3d inverse() const {
        const Vec3d r0 = cross(column[1], column[2]);
        const Vec3d r1 = cross(column[2], column[0]);
        const Vec3d r2 = cross(column[0], column[1]);
        const double s = 1.0 / dot(column[0], r0);
        Affine3d m{
            {Vec3d{r0.x, r1.x, r2.x} * s, Vec3d{r0.y, r1.y, r2.y} * s, Vec3d{r0.z, r1.z, r2.z} * s},
            {}};
        m.translation = -m.vector(translation);
        return m;
    }

    /// The axis-aligned box around the image of `box`.
    Box3d box(const Box3d& box) const {
        Box3d image;
        for (int i = 0; i < 8; ++i) image.add(point(box.corner(i)));
        return image;
    }

    static Affine3d translate(Vec3d t) { return {{Vec3d{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, t}; }
    static Affine3d scale(Vec3d s) { return {{Vec3d{s.x, 0, 0}, {0, s.y, 0}, {0, 0, s.z}}, {}}; }
    /// Right-handed rotation by `degrees` about coordinate axis 0, 1 or 2.
    static Affine3d rotate(int axis, double degrees) {
        const double c = std::cos(degrees * pi / 180), s = std::sin(degrees * pi / 180);
        Affine3d m;
        const int j = (axis + 1) % 3, k = (axis + 2) % 3;
        m.column[static_cast<size_t>(j)][j] = c, m.column[static_cast<size_t>(j)][k] = s;
        m.column[static_cast<size_t>(k)][j] = -s, m.column[static_cast<size_t>(k)][k] = c;
        return m;
    }
};

/// Why a map cannot be used in both directions, such as "is not finite"; empty where it can. Its
/// axes must be 1e-50 to 1e50 long and not lie in one plane. So two maps in a row, and the squares
/// of their axes, stay within doubles.
std::string flawOf(const Affine3d& map);

}  // namespace woodcock
