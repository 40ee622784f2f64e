// SPDX-License-Identifier: Apache-2.0
#include "woodcock/surface/geometry_mesh.h"

#include <algorithm>
#include <cmath>

namespace woodcock::surface {

Frame::Frame(const Box3d& box) {
    if (box.empty()) return;
    centre = box.lower * 0.5 + box.upper * 0.5;
    const Vec3d size = box.size();
    const double largest = std::max({size.x, size.y, size.z});
    if (largest > 0) scale = std::ldexp(1.0, std::clamp(-std::ilogb(largest), -1000, 1000));
}

FramedMesh::FramedMesh(const mesh::SurfaceMesh& mesh, const EmbreeDevice& device) : mesh_(&mesh) {
    const Box3d box = mesh::boundsOf(mesh.mesh);
    frame_ = Frame(box);
    box_ = {frame_.point(box.lower), frame_.point(box.upper)};
    constexpr double doubles = 0x1p-44;  // in a frame of about unit size
    largestRounding_ = doubles;
    for (int axis = 0; axis < 3; ++axis)
        largestRounding_ +=
            0x1p-23 * frame_.scale * std::max(std::abs(box.lower[axis]), std::abs(box.upper[axis]));
    tree_ = EmbreeTree(
        device, mesh.mesh.points.size(),
        [&](std::size_t i) { return frame_.point(mesh.mesh.points[i].as<double>()); },
        mesh.mesh.triangles);
}

Triangle FramedMesh::triangle(std::uint32_t index) const {
    const auto& corners = mesh_->mesh.triangles[index];
    const auto corner = [&](std::size_t i) {
        return frame_.point(mesh_->mesh.points[corners[i]].as<double>());
    };
    return Triangle({corner(0), corner(1), corner(2)});
}

namespace {

/// The triangle that a ray starts on. The ray's side of it tells which triangles it can meet.
struct Start {
    std::uint32_t triangle;
    double side;  ///< direction . normal
};

struct NearestTriangle final : TriangleVisitor {
    const FramedMesh& mesh;
    LocalRay ray;  ///< from from its point at `from`
    double from = 0;
    double speed;
    double error = floatError;  ///< of the search
    std::optional<Start> start;
    const FramedMesh::TestsTriangle& alsoLeft;
    MeshPoint nearest;  ///< t: so far
    double slack = 0;   ///< what rounding may make of that t
    bool found = false;
    double side = 0;  ///< direction . normal, of what was found

    NearestTriangle(const FramedMesh& m, const LocalRay& r, double begin, double tMax,
                    const FramedMesh::TestsTriangle& others)
        : mesh(m),
          ray{r.at(begin), r.direction},
          from(begin),
          speed(length(r.direction)),
          alsoLeft(others) {
        nearest.t = tMax;
    }

    bool accept(std::uint32_t index) override {
        if (start && index == start->triangle) return false;
        const Triangle triangle = mesh.triangle(index);
        const std::optional<TrianglePoint> point = meetTriangle(ray, speed, triangle, error);
        if (!point) return false;
        const double t = from + point->t;
        if (!(t > 0) || !(t < nearest.t + slack)) return false;
        // Near the edge where the ray starts, and where it passes an edge, only the side can tell a
        // hit from a rounding error: a ray that starts inside can only leave, and one that starts
        // outside can only enter.
        const double thisSide = dot(ray.direction, triangle.normal);
        const bool doubtful = !point->within || t * speed < 4 * point->tolerance;
        if (start && doubtful && thisSide * start->side > 0) return false;
        if (alsoLeft && alsoLeft(index, triangle)) return false;
        // `tolerance` follows from the error of the search; the error of rounding is in proportion.
        const double thisSlack = 4 * mesh.largestRounding() * point->tolerance / (error * speed);
        const bool coincident = found && std::abs(t - nearest.t) <= std::max(slack, thisSlack);
        if (!(t < nearest.t)) {
            nearest.coincident = nearest.coincident || coincident;
            return false;
        }
        nearest = {t,         index,     point->weights, error / point->tolerance * speed,
                   thisSlack, coincident};
        slack = thisSlack;
        beyond = thisSlack * speed + 3 * EmbreeTree::margin;
        side = thisSide;
        found = true;
        return true;
    }

    /// True where the search met no triangle of a closed mesh, or met it from the wrong side.
    bool missed() const { return start && (found ? side * start->side > 0 : start->side < 0); }
};

struct Crossings final : TriangleVisitor {
    const FramedMesh& mesh;
    LocalRay ray;
    int leaving = 0;
    bool uncertain = false;

    Crossings(const FramedMesh& m, const LocalRay& r) : mesh(m), ray(r) {}

    bool accept(std::uint32_t index) override {
        const Triangle triangle = mesh.triangle(index);
        const std::optional<TrianglePoint> point =
            meetTriangle(ray, length(ray.direction), triangle, floatError);
        if (!point || !(point->t > 0)) return false;
        uncertain = uncertain || !point->within ||
                    edgeDistance(triangle, point->weights) < 2 * point->tolerance;
        leaving += dot(ray.direction, triangle.normal) > 0 ? 1 : -1;
        return false;
    }
};

}  // namespace

double FramedMesh::rounding(std::uint32_t index, Vec3d normal) const {
    Vec3d most;
    for (const std::uint32_t corner : mesh_->mesh.triangles[index]) {
        const Vec3d p = mesh_->mesh.points[corner].as<double>();
        for (int axis = 0; axis < 3; ++axis) most[axis] = std::max(most[axis], std::abs(p[axis]));
    }
    return 0x1p-23 * frame_.scale *
           (most.x * std::abs(normal.x) + most.y * std::abs(normal.y) +
            most.z * std::abs(normal.z));
}

void FramedMesh::around(Vec3d point, double radius,
                        const std::function<void(std::uint32_t)>& visit) const {
    tree_.around(point, radius, 0, visit);
}

std::optional<MeshPoint> FramedMesh::nearest(const LocalRay& ray, double tMax,
                                             std::optional<std::uint32_t> left,
                                             const TestsTriangle& alsoLeft) const {
    const RayInterval part = clip(ray, box_, EmbreeTree::margin, {0, tMax});
    if (part.empty()) return std::nullopt;
    NearestTriangle visitor(*this, ray, part.from, tMax, alsoLeft);
    if (!(visitor.speed > 0)) return std::nullopt;
    TreeRay treeRay{visitor.ray.origin, ray.direction * (1 / visitor.speed),
                    (part.to - part.from) * visitor.speed};
    if (left) visitor.start = {*left, dot(ray.direction, triangle(*left).normal)};
    tree_.traverse(treeRay, visitor);
    // A ray that leaves almost along the surface, beside an edge, may be on its other side in
    // floats.
    if (visitor.missed()) {
        constexpr double aside = 4 * floatError;
        const Vec3d normal = normalize(triangle(*left).normal);
        treeRay.origin += normal * std::copysign(aside, visitor.start->side);
        visitor.error = floatError + aside;
        tree_.traverse(treeRay, visitor);
    }
    return visitor.found ? std::optional(visitor.nearest) : std::nullopt;
}

bool FramedMesh::encloses(Vec3d point) const {
    if (!box_.contains(point)) return false;
    constexpr int ways = 9;  // another direction where one passes an edge too closely for floats
    int inside = 0;
    for (int k = 0; k < ways; ++k) {
        const double y = 1 - (2 * k + 1.0) / ways, azimuth = 0.7 + 2.399963229728653 * k;
        const double r = std::sqrt(1 - y * y);
        const LocalRay ray{point, {r * std::cos(azimuth), y, r * std::sin(azimuth)}};
        Crossings crossings(*this, ray);
        tree_.traverse({point, ray.direction, 2 * length(box_.size())}, crossings);
        if (!crossings.uncertain) return crossings.leaving > 0;
        inside += crossings.leaving > 0;
    }
    return 2 * inside > ways;
}

}  // namespace woodcock::surface
