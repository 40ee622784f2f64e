// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/polar.h"

#include <algorithm>
#include <cmath>

namespace woodcock {

namespace {

using Columns = std::array<Vec3d, 3>;

Columns transposed(const Columns& m) {
    return {Vec3d{m[0].x, m[1].x, m[2].x}, {m[0].y, m[1].y, m[2].y}, {m[0].z, m[1].z, m[2].z}};
}

/// The rotation nearest to a regular matrix of positive determinant, by Newton's iteration with
/// scaling: Higham 1986, "Computing the Polar Decomposition", eq. 3.2 and 3.5.
Columns rotationOf(Columns q) {
    const auto norm = [](const Columns& m) {
        return std::sqrt(dot(m[0], m[0]) + dot(m[1], m[1]) + dot(m[2], m[2]));
    };
    for (int i = 0; i < 100; ++i) {
        const Columns inverse = transposed(Affine3d{q, {}}.inverse().column);
        const double g = std::sqrt(norm(inverse) / norm(q));
        double change = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const Vec3d next = q[c] * (0.5 * g) + inverse[c] * (0.5 / g);
            change = std::max(change, length(next - q[c]));
            q[c] = next;
        }
        if (change < 1e-15) break;
    }
    return q;
}

/// Shepperd 1978: from the largest of the four, so that nothing cancels.
Quaternion quaternionOf(const Columns& m) {
    const double xx = m[0].x, yy = m[1].y, zz = m[2].z, trace = xx + yy + zz;
    Quaternion q;
    if (trace >= std::max({xx, yy, zz})) {
        q = {1 + trace, {m[1].z - m[2].y, m[2].x - m[0].z, m[0].y - m[1].x}};
    } else if (xx >= std::max(yy, zz)) {
        q = {m[1].z - m[2].y, {1 + xx - yy - zz, m[0].y + m[1].x, m[2].x + m[0].z}};
    } else if (yy >= zz) {
        q = {m[2].x - m[0].z, {m[0].y + m[1].x, 1 + yy - zz - xx, m[1].z + m[2].y}};
    } else {
        q = {m[0].y - m[1].x, {m[2].x + m[0].z, m[1].z + m[2].y, 1 + zz - xx - yy}};
    }
    const double size = std::sqrt(q.w * q.w + dot(q.v, q.v));
    return {q.w / size, q.v * (1 / size)};
}

Columns matrixOf(const Quaternion& q) {
    const double w = q.w, x = q.v.x, y = q.v.y, z = q.v.z;
    return {Vec3d{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
            {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
            {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

double dotOf(const Quaternion& a, const Quaternion& b) { return a.w * b.w + dot(a.v, b.v); }

}  // namespace

Affine3d PolarMap::map() const {
    return Affine3d{matrixOf(rotation), translation} * Affine3d{stretch, {}};
}

PolarMap polarOf(const Affine3d& map) {
    const double sign = map.determinant() < 0 ? -1 : 1;
    Columns m = map.column;
    for (Vec3d& column : m) column = column * sign;
    const Columns rotation = rotationOf(m);
    const Columns stretch = (Affine3d{transposed(rotation), {}} * Affine3d{map.column, {}}).column;
    PolarMap polar{map.translation, quaternionOf(rotation), {}};
    const Columns other = transposed(stretch);
    for (std::size_t c = 0; c < 3; ++c) polar.stretch[c] = (stretch[c] + other[c]) * 0.5;
    return polar;
}

double angleBetween(const Quaternion& a, const Quaternion& b) {
    const double cosine = dotOf(a, b), sign = cosine < 0 ? -1 : 1;
    const double difference =
        std::sqrt((a.w - sign * b.w) * (a.w - sign * b.w) +
                  dot(a.v - b.v * sign, a.v - b.v * sign));  // 2 sin(angle / 4)
    return 4 * std::asin(std::min(1.0, difference / 2));
}

PolarMap between(const PolarMap& a, const PolarMap& b, double s) {
    PolarMap p;
    p.translation = a.translation * (1 - s) + b.translation * s;
    for (std::size_t c = 0; c < 3; ++c) p.stretch[c] = a.stretch[c] * (1 - s) + b.stretch[c] * s;
    const double half = angleBetween(a.rotation, b.rotation) / 2;
    const double sign = dotOf(a.rotation, b.rotation) < 0 ? -1 : 1;
    double wa = 1 - s, wb = s;
    if (half > 1e-8) {
        const double sine = std::sin(half);
        wa = std::sin((1 - s) * half) / sine, wb = std::sin(s * half) / sine;
    }
    wb *= sign;
    const Quaternion q{a.rotation.w * wa + b.rotation.w * wb,
                       a.rotation.v * wa + b.rotation.v * wb};
    const double size = std::sqrt(dotOf(q, q));
    p.rotation = {q.w / size, q.v * (1 / size)};
    return p;
}

}  // namespace woodcock
