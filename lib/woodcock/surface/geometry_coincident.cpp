// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

#include "woodcock/surface/geometry_impl.h"

// Surfaces that coincide. Two faces that are meant to be one plane differ by rounding: of floats in
// the corners of meshes, and of doubles in transforms. Exactly that much is tolerated.

namespace woodcock::surface {

namespace {

/// Relative rounding of doubles: a few roundings each in a transform, its inverse, the frame of a
/// mesh and the point itself.
constexpr double doubleRounding = 0x1p-47;
/// The largest sine between two coincident faces. Rounding tilts them far less: otherwise they
/// would not pass through the same point.
constexpr double parallel = 1e-3;

Vec3d absolute(Vec3d v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.z)}; }

}  // namespace

double Geometry::Impl::reach(const InstancePlace& at, Vec3d normal, Vec3d point, double ofPlane) {
    return doubleRounding * dot(absolute(normal), absolute(point) + absolute(at.centre)) + ofPlane;
}

double Geometry::Impl::reach(std::uint32_t i, const InstancePlace& at,
                             const SurfaceHit& hit) const {
    double ofPlane = 0;
    if (const auto& mesh = shapeOf(i).mesh) {
        const Vec3d n = normalize(mesh->triangle(hit.primitive).normal);
        ofPlane = mesh->rounding(hit.primitive, n) / length(at.gradient(n));
    }
    return reach(at, hit.normal, hit.position, ofPlane);
}

double Geometry::Impl::slackOf(std::uint32_t i, const InstancePlace& at, const LocalRay& worldRay,
                               const LocalRay& ray, double t, const MeshPoint& point) const {
    const double numbers = largest(worldRay.origin) + t + largest(at.centre);
    double cosine = 1;  // of the local direction, times its length
    switch (shapeOf(i).kind) {
        case PreparedShape::Kind::Mesh:
            cosine = point.slope;
            break;
        case PreparedShape::Kind::Sphere:
            cosine = std::abs(dot(ray.direction, ray.at(t)));
            break;
        case PreparedShape::Kind::Disk:
        case PreparedShape::Kind::Plane:
            cosine = std::abs(ray.direction.y);
    }
    const double slack = point.slack + 4 * doubleRounding * at.stretch * numbers / cosine;
    return std::isfinite(slack) ? slack : 0;
}

Geometry::Impl::LocalHit::LocalHit(const Impl& geometry, const SurfaceHit& h, std::uint32_t i)
    : hit(h), instance(i), at(geometry.placed(i, h.time)), position(at->localPoint(h.position)) {
    constexpr double cracks = 0x1p-40;  // none between neighbours
    edges = cracks + doubleRounding * at->stretch * (largest(h.position) + largest(at->centre));
}

std::optional<CoincidentSurface> Geometry::Impl::LocalHit::inPlane(std::uint32_t object,
                                                                   std::uint32_t primitive, Vec3d n,
                                                                   double height,
                                                                   double rounding) const {
    const Vec3d gradient = at->gradient(n);
    const double perUnit = length(gradient);
    const Vec3d normal = gradient * (1 / perUnit);
    if (!isFinite(normal)) return std::nullopt;  // a triangle without area
    const double facing = dot(normal, hit.normal);
    if (dot(hit.normal, hit.normal) > 0 && !(facing * facing >= 1 - parallel * parallel))
        return std::nullopt;
    if (!(std::abs(height) / perUnit <=
          hit.coincident.reach + reach(*at, normal, hit.position, rounding / perUnit)))
        return std::nullopt;
    return CoincidentSurface{instance, object, primitive, facing, normal};
}

std::optional<CoincidentSurface> Geometry::Impl::passesThrough(const LocalHit& hit) const {
    const Vec3d p = hit.position;
    const std::uint32_t object = instances[hit.instance].object;
    const PreparedShape::Kind kind = shapeOf(hit.instance).kind;
    if (kind == PreparedShape::Kind::Sphere)
        return hit.inPlane(object, 0, normalize(p), length(p) - 1, 0);
    if (kind == PreparedShape::Kind::Disk && !(p.x * p.x + p.z * p.z <= 1)) return std::nullopt;
    return hit.inPlane(object, 0, {0, 1, 0}, p.y, 0);
}

std::optional<CoincidentSurface> Geometry::Impl::passesThrough(const LocalHit& hit,
                                                               std::uint32_t primitive,
                                                               const Triangle& triangle) const {
    const Vec3d p = hit.position;
    if (surelyBeside(triangle, p, hit.edges)) return std::nullopt;
    const Vec3d n = normalize(triangle.normal);
    const auto surface =
        hit.inPlane(instances[hit.instance].object, primitive, n, dot(p - triangle.corner[0], n),
                    shapeOf(hit.instance).mesh->rounding(primitive, n));
    if (!surface || !(edgeDistance(triangle, weightsAt(triangle, p)) >= -hit.edges))
        return std::nullopt;
    return surface;
}

void Geometry::coincidentSurfaces(const SurfaceHit& hit,
                                  std::vector<CoincidentSurface>& found) const {
    found.clear();
    const Impl& impl = *impl_;
    const auto add = [&](const std::optional<CoincidentSurface>& surface) {
        if (surface) found.push_back(*surface);
    };
    for (const std::uint32_t plane : impl.planes)
        add(impl.passesThrough(Impl::LocalHit(impl, hit, plane)));
    const auto visitInstance = [&](std::uint32_t box) {
        const std::uint32_t i = impl.finite[box];
        const Impl::LocalHit local(impl, hit, i);
        if (!impl.shapeOf(i).mesh) return add(impl.passesThrough(local));
        const Columns& m = local.at->localOfWorld;
        const double stretch = length(m[0]) + length(m[1]) + length(m[2]);
        const FramedMesh& mesh = *impl.shapeOf(i).mesh;
        const auto visitTriangle = [&](std::uint32_t index) {
            add(impl.passesThrough(local, index, mesh.triangle(index)));
        };
        mesh.around(local.position, stretch * hit.coincident.reach, std::cref(visitTriangle));
    };
    if (impl.tree)
        impl.tree.around(impl.frame.point(hit.position), hit.coincident.reach * impl.frame.scale,
                         hit.time, std::cref(visitInstance));
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
        return std::tie(a.instance, a.primitive) < std::tie(b.instance, b.primitive);
    });
}

SurfaceHit Geometry::inPlaceOf(const SurfaceHit& hit, const CoincidentSurface& other) const {
    SurfaceHit own = hit;
    own.instance = other.instance, own.object = other.object, own.primitive = other.primitive;
    const Impl& impl = *impl_;
    const Impl::Placement at = impl.placed(other.instance, hit.time);
    const Vec3d p = at->localPoint(hit.position);
    switch (impl.shapeOf(other.instance).kind) {
        case PreparedShape::Kind::Mesh: {
            const Triangle triangle = impl.shapeOf(other.instance).mesh->triangle(other.primitive);
            impl.completeMesh(at, triangle, awayFromEdges(triangle, weightsAt(triangle, p), 0),
                              own);
            break;
        }
        case PreparedShape::Kind::Sphere:
            impl.completeShape(at, normalize(p), own);
            break;
        case PreparedShape::Kind::Disk:
        case PreparedShape::Kind::Plane:
            impl.completeShape(at, {p.x, 0, p.z}, own);
    }
    // Both lie in one plane, so they share a normal: rounding must not put a direction on different
    // sides of the two.
    const bool turned = dot(own.normal, hit.normal) < 0;
    const Vec3d shading = own.shadingNormal;
    own.normal = turned ? -hit.normal : hit.normal;
    if (!(dot(shading, own.normal) > 0)) own.shadingNormal = own.normal;
    own.coincident.turned = hit.coincident.turned != turned;
    return own;
}

}  // namespace woodcock::surface
