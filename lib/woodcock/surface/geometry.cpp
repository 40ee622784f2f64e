// SPDX-License-Identifier: Apache-2.0
#include "woodcock/surface/geometry.h"

#include <algorithm>
#include <cmath>

#include "woodcock/base/error.h"
#include "woodcock/surface/embree_tree.h"
#include "woodcock/surface/geometry_mesh.h"
#include "woodcock/surface/geometry_solve.h"

// Each instance is a box of one tree, so that a million of them need little memory. What a ray
// meets of it is found in the frame of its shape: wherever it stands in the world, and however
// small it is beside others, no digit is lost.

namespace woodcock {

namespace {

/// A shape in its own frame.
struct Prepared {
    enum class Kind { Sphere, Disk, Plane, Mesh } kind = Kind::Mesh;
    std::optional<FramedMesh> mesh;  ///< of meshes that have triangles
    Frame frame;
    Box3d box;  ///< in its frame; empty where there is nothing of finite size
};

using Columns = std::array<Vec3d, 3>;
Vec3d times(const Columns& m, Vec3d v) { return m[0] * v.x + m[1] * v.y + m[2] * v.z; }
Vec3d timesTransposed(const Columns& m, Vec3d v) {
    return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}

struct Nearest {
    bool found = false;
    double t = 0;  ///< of the nearest so far
    std::uint32_t instance = 0;
    MeshPoint point;  ///< of meshes
};

}  // namespace

struct Geometry::Impl {
    std::vector<Shape> shapes;
    std::vector<ShapeInstance> instances;
    std::optional<EmbreeDevice> device;  ///< only where something is of finite size
    std::vector<Prepared> prepared;      ///< of each shape
    std::vector<Columns> localOfWorld;   ///< of each instance: directions to its shape's frame
    std::vector<std::uint32_t> finite, planes;
    Box3d bounds;
    Frame frame;  ///< of the tree
    EmbreeTree tree;

    Impl(std::vector<Shape> s, std::vector<ShapeInstance> i);
    void prepareShape(const Shape& shape);
    void placeInstance(std::uint32_t i);
    Box3d worldBox(std::uint32_t i) const;

    const Prepared& shapeOf(std::uint32_t i) const { return prepared[instances[i].shape]; }
    Vec3d centre(std::uint32_t i) const {
        return instances[i].worldFromObject.point(shapeOf(i).frame.centre);
    }
    LocalRay local(std::uint32_t i, const LocalRay& ray) const {
        return {times(localOfWorld[i], ray.origin - centre(i)),
                times(localOfWorld[i], ray.direction)};
    }
    Vec3d world(std::uint32_t i, Vec3d p) const {
        return instances[i].worldFromObject.vector(p * (1 / shapeOf(i).frame.scale)) + centre(i);
    }
    /// Which side is outside does not depend on the determinant's sign, as normals are covectors.
    Vec3d worldNormal(std::uint32_t i, Vec3d n) const {
        return normalize(timesTransposed(localOfWorld[i], n));
    }

    struct NearestVisitor;
    struct EnclosingVisitor;
    template <class Visitor>
    void visitInstances(const LocalRay& ray, Visitor& visitor) const;
    void meet(std::uint32_t i, const LocalRay& worldRay, const SurfaceHit* left,
              Nearest& nearest) const;
    bool encloses(std::uint32_t i, Vec3d point) const;
    void complete(const Nearest& nearest, const LocalRay& worldRay, SurfaceHit& hit) const;
    void completeMesh(const Nearest& nearest, SurfaceHit& hit) const;
};

Geometry::Impl::Impl(std::vector<Shape> s, std::vector<ShapeInstance> i)
    : shapes(std::move(s)), instances(std::move(i)) {
    for (const Shape& shape : shapes) prepareShape(shape);
    localOfWorld.reserve(instances.size());
    for (std::uint32_t n = 0; n < instances.size(); ++n) placeInstance(n);
    if (finite.empty()) return;
    frame = Frame(bounds);
    if (!device) device.emplace();
    tree = EmbreeTree(*device, static_cast<std::uint32_t>(finite.size()), [&](std::uint32_t n) {
        const Box3d box = worldBox(finite[n]);
        return Box3d{frame.point(box.lower), frame.point(box.upper)};
    });
}

void Geometry::Impl::prepareShape(const Shape& shape) {
    Prepared& p = prepared.emplace_back();
    if (std::holds_alternative<UnitSphere>(shape)) {
        p.kind = Prepared::Kind::Sphere;
        p.box = {{-1, -1, -1}, {1, 1, 1}};
    } else if (std::holds_alternative<UnitDisk>(shape)) {
        p.kind = Prepared::Kind::Disk;
        p.box = {{-1, 0, -1}, {1, 0, 1}};
    } else if (std::holds_alternative<InfinitePlane>(shape)) {
        p.kind = Prepared::Kind::Plane;
    } else if (const auto& mesh = *std::get<std::shared_ptr<const SurfaceMesh>>(shape);
               !mesh.mesh.triangles.empty()) {
        if (!device) device.emplace();
        p.mesh.emplace(mesh, *device);
        p.frame = p.mesh->frame();
        p.box = p.mesh->box();
    }
}

void Geometry::Impl::placeInstance(std::uint32_t i) {
    const ShapeInstance& instance = instances[i];
    const Prepared& shape = prepared.at(instance.shape);
    const Affine3d& m = instance.worldFromObject;
    Columns inverse = Affine3d{m.column, {}}.inverse().column;
    for (Vec3d& column : inverse) column = column * shape.frame.scale;
    const double sides = length(m.column[0]) * length(m.column[1]) * length(m.column[2]);
    const bool invertible = isFinite(inverse[0]) && isFinite(inverse[1]) && isFinite(inverse[2]);
    constexpr double flat = 1e-14;  // of the box of its columns' lengths
    if (!std::isfinite(sides) || !isFinite(m.translation))
        throw inputError("the transform of instance {} (object {}) is not finite", i,
                         instance.object);
    if (!invertible || !(std::abs(m.determinant()) > flat * sides))
        throw inputError("the transform of instance {} (object {}) makes its shape flat", i,
                         instance.object);
    localOfWorld.push_back(inverse);
    if (shape.kind == Prepared::Kind::Plane) {
        planes.push_back(i);
    } else if (!shape.box.empty()) {
        finite.push_back(i);
        bounds.add(worldBox(i));
    }
}

Box3d Geometry::Impl::worldBox(std::uint32_t i) const {
    const Prepared& shape = shapeOf(i);
    if (shape.kind == Prepared::Kind::Sphere) {
        const Columns& c = instances[i].worldFromObject.column;
        const Vec3d half{length(Vec3d{c[0].x, c[1].x, c[2].x}),
                         length(Vec3d{c[0].y, c[1].y, c[2].y}),
                         length(Vec3d{c[0].z, c[1].z, c[2].z})};
        return {centre(i) - half, centre(i) + half};
    }
    Box3d box;
    for (int corner = 0; corner < 8; ++corner) box.add(world(i, shape.box.corner(corner)));
    return box;
}

template <class Visitor>
void Geometry::Impl::visitInstances(const LocalRay& ray, Visitor& visitor) const {
    for (const std::uint32_t plane : planes) visitor.visitInstance(plane);
    if (!tree) return;
    const RayInterval part =
        clip(ray, bounds, EmbreeTree::margin / frame.scale, {0, visitor.end()});
    const double speed = length(ray.direction);
    if (part.empty() || !(speed > 0)) return;
    visitor.from = part.from;
    visitor.perUnit = speed * frame.scale;
    tree.traverse({frame.point(ray.at(part.from)), ray.direction * (1 / speed),
                   (part.to - part.from) * visitor.perUnit},
                  visitor);
}

struct Geometry::Impl::NearestVisitor final : BoxVisitor {
    const Impl& impl;
    const LocalRay& ray;
    const SurfaceHit* left;
    Nearest nearest;
    double from = 0, perUnit = 1;  ///< of the tree's ray: where it begins, its units in one of t

    NearestVisitor(const Impl& i, const LocalRay& r, double tMax, const SurfaceHit* l)
        : impl(i), ray(r), left(l) {
        nearest.t = tMax;
    }
    double end() const { return nearest.t; }
    void visitInstance(std::uint32_t i) { impl.meet(i, ray, left, nearest); }
    double visit(std::uint32_t box) override {
        visitInstance(impl.finite[box]);
        return (nearest.t - from) * perUnit;
    }
};

struct Geometry::Impl::EnclosingVisitor final : BoxVisitor {
    const Impl& impl;
    Vec3d point;
    const std::vector<bool>& closed;
    std::vector<std::uint32_t> found;
    double from = 0, perUnit = 1;

    EnclosingVisitor(const Impl& i, Vec3d p, const std::vector<bool>& c)
        : impl(i), point(p), closed(c) {}
    double end() const { return 0; }  // boxes around the point alone
    void visitInstance(std::uint32_t i) {
        const std::uint32_t object = impl.instances[i].object;
        if (object < closed.size() && closed[object] && impl.encloses(i, point)) found.push_back(i);
    }
    double visit(std::uint32_t box) override {
        visitInstance(impl.finite[box]);
        return 0;
    }
};

void Geometry::Impl::meet(std::uint32_t i, const LocalRay& worldRay, const SurfaceHit* left,
                          Nearest& nearest) const {
    const Prepared& shape = shapeOf(i);
    const LocalRay ray = local(i, worldRay);
    const bool starts = left && left->instance == i;
    std::optional<double> t;
    switch (shape.kind) {
        case Prepared::Kind::Mesh:
            if (const std::optional<MeshPoint> point = shape.mesh->nearest(
                    ray, nearest.t, starts ? std::optional(left->primitive) : std::nullopt)) {
                nearest.point = *point;
                t = point->t;
            }
            break;
        case Prepared::Kind::Sphere:
            if (!starts)
                t = meetSphere(ray, nearest.t);
            else if (dot(worldRay.direction, left->normal) < 0)
                t = crossSphere(ray);
            break;
        case Prepared::Kind::Disk:
        case Prepared::Kind::Plane:
            if (starts) break;
            t = meetPlane(ray, nearest.t);
            if (t && shape.kind == Prepared::Kind::Disk) {
                const Vec3d p = ray.at(*t);
                if (!(p.x * p.x + p.z * p.z <= 1)) t.reset();
            }
    }
    if (!t || !(*t < nearest.t)) return;
    nearest.found = true;
    nearest.t = *t;
    nearest.instance = i;
}

bool Geometry::Impl::encloses(std::uint32_t i, Vec3d point) const {
    const Prepared& shape = shapeOf(i);
    const Vec3d p = local(i, {point, {}}).origin;
    switch (shape.kind) {
        case Prepared::Kind::Sphere:
            return dot(p, p) < 1;
        case Prepared::Kind::Plane:
            return p.y < 0;
        case Prepared::Kind::Disk:
            return false;
        case Prepared::Kind::Mesh:
            return shape.mesh->encloses(p);
    }
    return false;
}

void Geometry::Impl::complete(const Nearest& nearest, const LocalRay& worldRay,
                              SurfaceHit& hit) const {
    const std::uint32_t i = nearest.instance;
    hit.t = nearest.t;
    hit.instance = i;
    hit.primitive = 0;
    hit.object = instances[i].object;
    const Prepared::Kind kind = shapeOf(i).kind;
    if (kind == Prepared::Kind::Mesh) return completeMesh(nearest, hit);
    Vec3d p = local(i, worldRay).at(hit.t);
    if (kind == Prepared::Kind::Sphere) {
        p = normalize(p);
        hit.normal = worldNormal(i, p);
        const double longitude = std::atan2(-p.z, p.x) / (2 * pi);
        hit.u = longitude < 0 ? longitude + 1 : longitude;
        hit.v = 0.5 + std::asin(std::clamp(p.y, -1.0, 1.0)) / pi;
    } else {
        p.y = 0;
        hit.normal = worldNormal(i, {0, 1, 0});
        const bool disk = kind == Prepared::Kind::Disk;  // an image fits the square around it
        hit.u = disk ? (1 + p.x) / 2 : p.x;
        hit.v = disk ? (1 - p.z) / 2 : -p.z;
    }
    hit.shadingNormal = hit.normal;
    hit.position = world(i, p);
}

void Geometry::Impl::completeMesh(const Nearest& nearest, SurfaceHit& hit) const {
    const std::uint32_t i = nearest.instance;
    const FramedMesh& framed = *shapeOf(i).mesh;
    const SurfaceMesh& mesh = framed.mesh();
    const auto& [t, primitive, w] = nearest.point;
    const Triangle triangle = framed.triangle(primitive);
    hit.primitive = primitive;
    // Who leaves from the very edge could pass between two triangles, as floats see them.
    hit.position = world(i, triangle.at(awayFromEdges(triangle, w, floatError)));
    hit.normal = worldNormal(i, triangle.normal);
    hit.shadingNormal = hit.normal;
    hit.u = hit.v = 0;
    if (!mesh.uvs.empty()) {
        const auto& uv = mesh.uvs[primitive];
        for (std::size_t k = 0; k < 3; ++k) {
            hit.u += w[k] * static_cast<double>(uv[k].u);
            hit.v += w[k] * static_cast<double>(uv[k].v);
        }
    }
    if (mesh.normals.empty()) return;
    Vec3d sum, interpolated;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d n = mesh.normals[primitive][k].as<double>();
        sum += n, interpolated += n * w[k];
    }
    // Some files turn their normals against their triangles.
    if (dot(sum, triangle.normal) < 0) interpolated = -interpolated;
    Vec3d n = worldNormal(i, interpolated);
    constexpr double least = 1e-3;  // cosine: bent to just above the surface
    const double cosine = dot(n, hit.normal);
    if (cosine < least) n = normalize(n + hit.normal * (least - cosine));
    if (isFinite(n)) hit.shadingNormal = n;
}

Geometry::Geometry(std::vector<Shape> shapes, std::vector<ShapeInstance> instances)
    : impl_(std::make_unique<Impl>(std::move(shapes), std::move(instances))) {}
Geometry::~Geometry() = default;
Geometry::Geometry(Geometry&&) noexcept = default;
Geometry& Geometry::operator=(Geometry&&) noexcept = default;

const std::vector<Shape>& Geometry::shapes() const { return impl_->shapes; }
const std::vector<ShapeInstance>& Geometry::instances() const { return impl_->instances; }
Box3d Geometry::bounds() const { return impl_->bounds; }

bool Geometry::intersect(Vec3d origin, Vec3d direction, double tMax, const SurfaceHit* left,
                         SurfaceHit& hit) const {
    if (!isFinite(origin) || !isFinite(direction)) return false;
    const LocalRay ray{origin, direction};
    Impl::NearestVisitor visitor(*impl_, ray, tMax, left);
    impl_->visitInstances(ray, visitor);
    if (visitor.nearest.found) impl_->complete(visitor.nearest, ray, hit);
    return visitor.nearest.found;
}

std::vector<std::uint32_t> Geometry::enclosing(Vec3d point, const std::vector<bool>& closed) const {
    if (!isFinite(point)) return {};
    Impl::EnclosingVisitor visitor(*impl_, point, closed);
    impl_->visitInstances({point, {0, 0, 1}}, visitor);
    std::sort(visitor.found.begin(), visitor.found.end());
    return std::move(visitor.found);
}

std::size_t Geometry::memoryBytes() const {
    return (impl_->device ? impl_->device->memoryBytes() : 0) +
           impl_->instances.capacity() * sizeof(ShapeInstance) +
           impl_->localOfWorld.capacity() * sizeof(Columns) +
           impl_->finite.capacity() * sizeof(std::uint32_t);
}

}  // namespace woodcock
