// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
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
double largest(Vec3d v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

}  // namespace

double Geometry::Impl::reach(std::uint32_t i, const Placement& at, std::uint32_t primitive,
                             Vec3d normal, Vec3d point) const {
    const double doubles =
        doubleRounding * dot(absolute(normal), absolute(point) + absolute(centre(i, at)));
    if (shapeOf(i).kind != PreparedShape::Kind::Mesh) return doubles;
    const FramedMesh& mesh = *shapeOf(i).mesh;
    const Vec3d n = normalize(mesh.triangle(primitive).normal);
    return doubles + mesh.rounding(primitive, n) / length(timesTransposed(at.localOfWorld(), n));
}

double Geometry::Impl::slackOf(std::uint32_t i, const Placement& at, const LocalRay& worldRay,
                               const LocalRay& ray, double t, const MeshPoint& point) const {
    const Columns& m = at.localOfWorld();
    const double stretch = largest(m[0]) + largest(m[1]) + largest(m[2]);
    const double numbers = largest(worldRay.origin) + t + largest(centre(i, at));
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
    const double slack = point.slack + 4 * doubleRounding * stretch * numbers / cosine;
    return std::isfinite(slack) ? slack : 0;
}

std::optional<CoincidentSurface> Geometry::Impl::passesThrough(const SurfaceHit& hit,
                                                               std::uint32_t i,
                                                               std::uint32_t primitive) const {
    const PreparedShape& shape = shapeOf(i);
    const Placement at = placed(i, hit.time);
    const Vec3d p = local(i, at, {hit.position, {}}).origin;
    // In the shape's frame: the normal, and the point's height above the surface.
    Vec3d n{0, 1, 0};
    double height = p.y;
    std::optional<Triangle> triangle;
    if (shape.kind == PreparedShape::Kind::Sphere) {
        n = normalize(p), height = length(p) - 1;
    } else if (shape.kind == PreparedShape::Kind::Mesh) {
        triangle.emplace(shape.mesh->triangle(primitive));
        n = normalize(triangle->normal), height = dot(p - triangle->corner[0], n);
    }
    const Vec3d gradient = timesTransposed(at.localOfWorld(), n);
    const double perUnit = length(gradient);
    const Vec3d normal = gradient * (1 / perUnit);
    if (!isFinite(normal)) return std::nullopt;  // a triangle without area
    if (!(std::abs(height) / perUnit <=
          hit.coincident.reach + reach(i, at, primitive, normal, hit.position)))
        return std::nullopt;
    const double facing = dot(normal, hit.normal);
    if (dot(hit.normal, hit.normal) > 0 && !(facing * facing >= 1 - parallel * parallel))
        return std::nullopt;
    if (shape.kind == PreparedShape::Kind::Disk && !(p.x * p.x + p.z * p.z <= 1))
        return std::nullopt;
    if (triangle) {
        constexpr double edges = 0x1p-40;  // no cracks between neighbours
        const Columns& m = at.localOfWorld();
        const double lost = doubleRounding * (largest(m[0]) + largest(m[1]) + largest(m[2])) *
                            (largest(hit.position) + largest(centre(i, at)));
        if (!(edgeDistance(*triangle, p) >= -(edges + lost))) return std::nullopt;
    }
    return CoincidentSurface{i, instances[i].object, primitive, facing, normal};
}

void Geometry::coincidentSurfaces(const SurfaceHit& hit,
                                  std::vector<CoincidentSurface>& found) const {
    found.clear();
    const Impl& impl = *impl_;
    const auto add = [&](std::uint32_t i, std::uint32_t primitive) {
        if (const auto surface = impl.passesThrough(hit, i, primitive)) found.push_back(*surface);
    };
    for (const std::uint32_t plane : impl.planes) add(plane, 0);
    if (impl.tree)
        impl.tree.around(impl.frame.point(hit.position), hit.coincident.reach * impl.frame.scale,
                         hit.time, [&](std::uint32_t box) {
                             const std::uint32_t i = impl.finite[box];
                             if (!impl.shapeOf(i).mesh) return add(i, 0);
                             const Impl::Placement at = impl.placed(i, hit.time);
                             const Vec3d p = impl.local(i, at, {hit.position, {}}).origin;
                             const Columns& m = at.localOfWorld();
                             const double stretch = length(m[0]) + length(m[1]) + length(m[2]);
                             const FramedMesh& mesh = *impl.shapeOf(i).mesh;
                             mesh.around(p, stretch * hit.coincident.reach,
                                         [&](std::uint32_t triangle) { add(i, triangle); });
                         });
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
        return std::tie(a.instance, a.primitive) < std::tie(b.instance, b.primitive);
    });
}

SurfaceHit Geometry::inPlaceOf(const SurfaceHit& hit, const CoincidentSurface& other) const {
    SurfaceHit own = hit;
    own.instance = other.instance, own.object = other.object, own.primitive = other.primitive;
    const Impl& impl = *impl_;
    const Impl::Placement at = impl.placed(other.instance, hit.time);
    const Vec3d p = impl.local(other.instance, at, {hit.position, {}}).origin;
    switch (impl.shapeOf(other.instance).kind) {
        case PreparedShape::Kind::Mesh: {
            MeshPoint point;
            point.triangle = other.primitive;
            const Triangle triangle = impl.shapeOf(other.instance).mesh->triangle(other.primitive);
            point.weights = awayFromEdges(triangle, weightsAt(triangle, p), 0);
            impl.completeMesh(at, point, own);
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
