// SPDX-License-Identifier: Apache-2.0
#include "woodcock/surface/geometry_solve.h"

namespace woodcock::surface {

namespace {

/// Distances of each corner from the opposite edge.
std::array<double, 3> heights(const Triangle& triangle) {
    const auto& p = triangle.corner;
    const double twiceArea = length(triangle.normal);
    return {twiceArea / length(p[2] - p[1]), twiceArea / length(p[0] - p[2]),
            twiceArea / length(p[1] - p[0])};
}

std::array<double, 3> weightsAt(const Triangle& triangle, Vec3d p, double twiceArea) {
    const double scale = 1 / (twiceArea * twiceArea);
    const auto& c = triangle.corner;
    std::array<double, 3> w;
    w[1] = dot(cross(p - c[0], c[2] - c[0]), triangle.normal) * scale;
    w[2] = dot(cross(c[1] - c[0], p - c[0]), triangle.normal) * scale;
    w[0] = 1 - w[1] - w[2];
    return w;
}

double squareOf(Vec3d v) { return dot(v, v); }

/// True only where each weight is at least `margin` of its height, and nearly always then. It
/// compares squares, which takes no root and no division, with a factor to spare for rounding.
bool surelyWithin(const Triangle& triangle, const std::array<double, 3>& w, double margin) {
    const auto& p = triangle.corner;
    const double square = squareOf(triangle.normal), limit = 4 * margin * margin;
    const auto far = [&](double weight, Vec3d edge) {
        return weight > 0 && weight * weight * square > limit * squareOf(edge);
    };
    return far(w[0], p[2] - p[1]) && far(w[1], p[0] - p[2]) && far(w[2], p[1] - p[0]);
}

}  // namespace

RayInterval clip(const LocalRay& ray, const Box3d& box, double margin, RayInterval within) {
    double from = within.from, to = within.to;
    for (int axis = 0; axis < 3; ++axis) {
        const double lower = box.lower[axis] - margin - ray.origin[axis];
        const double upper = box.upper[axis] + margin - ray.origin[axis];
        const double d = ray.direction[axis];
        if (d == 0) {
            if (lower > 0 || upper < 0) return {1, 0};
            continue;
        }
        // Both are divided at once. The processor cannot guess which way a ray goes.
        const double a = lower / d, b = upper / d;
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
    }
    return {from, to};
}

std::optional<double> meetSphere(const LocalRay& ray, double tMax) {
    // Solved from the ray's point closest to the centre: a difference of squares would lose the
    // digits of a far origin.
    const double a = dot(ray.direction, ray.direction);
    const double closest = -dot(ray.origin, ray.direction) / a;
    const Vec3d p = ray.at(closest);
    const double square = (1 - dot(p, p)) / a;
    if (!(square >= 0)) return std::nullopt;
    const double half = std::sqrt(square);
    for (const double t : {closest - half, closest + half})
        if (t > 0) return t < tMax ? std::optional(t) : std::nullopt;
    return std::nullopt;
}

double crossSphere(const LocalRay& ray) {
    const double t = -2 * dot(ray.origin, ray.direction) / dot(ray.direction, ray.direction);
    // A grazing ray has no length inside; it still has to leave.
    return std::max(t, std::numeric_limits<double>::min());
}

std::optional<double> meetPlane(const LocalRay& ray, double tMax) {
    const double t = -ray.origin.y / ray.direction.y;
    return t > 0 && t < tMax ? std::optional(t) : std::nullopt;
}

std::array<double, 3> weightsAt(const Triangle& triangle, Vec3d point) {
    return weightsAt(triangle, point, length(triangle.normal));
}

double edgeDistance(const Triangle& triangle, const std::array<double, 3>& w) {
    const std::array<double, 3> height = heights(triangle);
    return std::min({w[0] * height[0], w[1] * height[1], w[2] * height[2]});
}

bool surelyBeside(const Triangle& triangle, Vec3d point, double margin) {
    // The weights times `square`, each against twice the margin, in squares as in surelyWithin().
    const auto& c = triangle.corner;
    const Vec3d edge1 = c[1] - c[0], edge2 = c[2] - c[0], from0 = point - c[0];
    const double square = squareOf(triangle.normal), limit = 4 * margin * margin * square;
    if (!(square > 1e-150)) return false;  // the squares below could vanish
    const double w1 = dot(cross(from0, edge2), triangle.normal),
                 w2 = dot(cross(edge1, from0), triangle.normal), w0 = square - w1 - w2;
    const auto beside = [&](double weight, Vec3d edge) {
        return weight < 0 && weight * weight > limit * squareOf(edge);
    };
    if (beside(w1, edge2) || beside(w2, edge1)) return true;
    // This weight is what is left of the others: where they are large, rounding spoils it.
    constexpr double large = 16;
    return std::abs(w1) + std::abs(w2) < large * square && beside(w0, c[2] - c[1]);
}

std::optional<TrianglePoint> meetTriangle(const LocalRay& ray, double speed,
                                          const Triangle& triangle, double error) {
    const double slope = dot(ray.direction, triangle.normal);
    const double twiceArea = length(triangle.normal);
    if (slope == 0 || !(twiceArea > 0)) return std::nullopt;
    TrianglePoint point;
    point.t = dot(triangle.corner[0] - ray.origin, triangle.normal) / slope;
    auto& w = point.weights;
    w = weightsAt(triangle, ray.at(point.t), twiceArea);

    const double cosine = std::abs(slope) / (speed * twiceArea);
    point.tolerance = error / cosine;
    if (w[0] >= 0 && w[1] >= 0 && w[2] >= 0) return point;  // nearly always
    const double edge = edgeDistance(triangle, w);
    if (!(edge >= -point.tolerance)) return std::nullopt;
    if (edge < 0) {
        point.within = false;
        w = awayFromEdges(triangle, w, 0);
        point.t =
            dot(triangle.at(w) - ray.origin, ray.direction) / dot(ray.direction, ray.direction);
    }
    return point;
}

std::array<double, 3> awayFromEdges(const Triangle& triangle, std::array<double, 3> weights,
                                    double margin) {
    if (surelyWithin(triangle, weights, margin)) return weights;
    const std::array<double, 3> height = heights(triangle);
    std::array<double, 3> least;
    double room = 1, slack = 0;
    bool inside = true;
    for (std::size_t i = 0; i < 3; ++i) {
        least[i] = std::min(margin / height[i], 1.0 / 3);
        inside = inside && weights[i] >= least[i];
        weights[i] = std::max(weights[i], least[i]);
        room -= least[i];
        slack += weights[i] - least[i];
    }
    if (inside) return weights;
    const double share = slack > 0 ? std::max(room, 0.0) / slack : 0;
    for (std::size_t i = 0; i < 3; ++i) weights[i] = least[i] + (weights[i] - least[i]) * share;
    return weights;
}

}  // namespace woodcock::surface
