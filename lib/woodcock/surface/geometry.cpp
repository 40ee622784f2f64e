// SPDX-License-Identifier: Apache-2.0
#include "woodcock/surface/geometry.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "woodcock/base/error.h"
#include "woodcock/surface/geometry_impl.h"

namespace woodcock::surface {

Geometry::Impl::Impl(std::vector<Shape> s, std::vector<ShapeInstance> i)
    : shapes(std::move(s)), instances(std::move(i)) {
    for (const Shape& shape : shapes) prepareShape(shape);
    places.reserve(instances.size());
    for (std::uint32_t n = 0; n < instances.size(); ++n) placeInstance(n);
    if (finite.empty()) return;
    buildTree();
}

void Geometry::Impl::buildTree() {
    frame = Frame(bounds);
    if (!device) device.emplace();
    const auto count = static_cast<std::uint32_t>(finite.size());
    const auto framed = [&](const Box3d& box) {
        return Box3d{frame.point(box.lower), frame.point(box.upper)};
    };
    if (!moves) {
        tree = EmbreeTree(*device, count,
                          [&](std::uint32_t n) { return framed(worldBox(finite[n])); });
        return;
    }
    std::vector<std::vector<Box3d>> boxes;
    for (const std::uint32_t i : finite) boxes.push_back(boxesAtSteps(i));
    tree = EmbreeTree(*device, count, timeSteps, [&](std::uint32_t n, std::uint32_t step) {
        return framed(boxes[n][std::min<std::size_t>(step, boxes[n].size() - 1)]);
    });
}

// Embree interpolates the boxes of two steps linearly. A box that is larger by what the way
// between them strays from that holds its instance at all times. How far it strays is found at
// `looks` times between, and grows by no more than the speed allows in between those.
std::vector<Box3d> Geometry::Impl::boxesAtSteps(std::uint32_t i) const {
    const MovingTransform* const motion = instances[i].motion.get();
    if (!motion || motion->jumps()) return {worldBox(i)};
    const Affine3d& rest = instances[i].worldFromObject;
    const auto boxNow = [&](double u) { return boxAt(i, motion->at(u) * rest); };
    constexpr int looks = 8;
    constexpr std::uint32_t spans = timeSteps - 1;
    std::vector<Box3d> boxes;
    for (std::uint32_t k = 0; k <= spans; ++k) boxes.push_back(boxNow(double(k) / spans));
    if (motion->straight()) return boxes;
    double strays = 0;
    for (std::uint32_t k = 0; k < spans; ++k)
        for (int look = 1; look < looks; ++look) {
            const double s = double(look) / looks;
            const Box3d now = boxNow((k + s) / spans);
            const Vec3d lower = boxes[k].lower * (1 - s) + boxes[k + 1].lower * s,
                        upper = boxes[k].upper * (1 - s) + boxes[k + 1].upper * s;
            for (int axis = 0; axis < 3; ++axis)
                strays = std::max(
                    {strays, lower[axis] - now.lower[axis], now.upper[axis] - upper[axis]});
        }
    strays += motion->largestSpeed(boxAt(i, rest)) / (looks * spans);
    for (Box3d& box : boxes) {
        box.lower = box.lower - Vec3d{1, 1, 1} * strays;
        box.upper = box.upper + Vec3d{1, 1, 1} * strays;
    }
    return boxes;
}

Affine3d Geometry::Impl::worldFromObjectAt(std::uint32_t i, float time) const {
    return instances[i].motion->at(double{time}) * instances[i].worldFromObject;
}

void Geometry::Impl::prepareShape(const Shape& shape) {
    PreparedShape& p = prepared.emplace_back();
    if (std::holds_alternative<UnitSphere>(shape)) {
        p.kind = PreparedShape::Kind::Sphere;
        p.box = {{-1, -1, -1}, {1, 1, 1}};
    } else if (std::holds_alternative<UnitDisk>(shape)) {
        p.kind = PreparedShape::Kind::Disk;
        p.box = {{-1, 0, -1}, {1, 0, 1}};
    } else if (std::holds_alternative<InfinitePlane>(shape)) {
        p.kind = PreparedShape::Kind::Plane;
    } else if (const auto& mesh = *std::get<std::shared_ptr<const mesh::SurfaceMesh>>(shape);
               !mesh.mesh.triangles.empty()) {
        if (!device) device.emplace();
        p.mesh.emplace(mesh, *device);
        p.frame = p.mesh->frame();
        p.box = p.mesh->box();
    }
}

InstancePlace Geometry::Impl::placeAt(std::uint32_t i, const Affine3d& worldFromObject) const {
    const Frame& own = shapeOf(i).frame;
    Columns m = Affine3d{worldFromObject.column, {}}.inverse().column;
    for (Vec3d& column : m) column = column * own.scale;
    return {m, worldFromObject.point(own.centre), largest(m[0]) + largest(m[1]) + largest(m[2])};
}

void Geometry::Impl::placeInstance(std::uint32_t i) {
    const ShapeInstance& instance = instances[i];
    const PreparedShape& shape = prepared.at(instance.shape);
    const Affine3d& m = instance.worldFromObject;
    const InstancePlace place = placeAt(i, m);
    const Columns& inverse = place.localOfWorld;
    const double sides = length(m.column[0]) * length(m.column[1]) * length(m.column[2]);
    const bool invertible = isFinite(inverse[0]) && isFinite(inverse[1]) && isFinite(inverse[2]);
    constexpr double flat = 1e-14;  // of the box of its columns' lengths
    if (!std::isfinite(sides) || !isFinite(m.translation))
        throw inputError("the transform of instance {} (object {}) is not finite", i,
                         instance.object);
    if (!invertible || !(std::abs(m.determinant()) > flat * sides))
        throw inputError("the transform of instance {} (object {}) flattens its shape", i,
                         instance.object);
    places.push_back(place);
    moves |= instance.motion != nullptr;
    if (shape.kind == PreparedShape::Kind::Plane) {
        planes.push_back(i);
    } else if (!shape.box.empty()) {
        finite.push_back(i);
        bounds.add(worldBox(i));
    }
}

Box3d Geometry::Impl::boxAt(std::uint32_t i, const Affine3d& worldFromObject) const {
    const PreparedShape& shape = shapeOf(i);
    const InstancePlace place = placeAt(i, worldFromObject);
    if (shape.kind == PreparedShape::Kind::Sphere) {
        const Columns& c = worldFromObject.column;
        const Vec3d half{length(Vec3d{c[0].x, c[1].x, c[2].x}),
                         length(Vec3d{c[0].y, c[1].y, c[2].y}),
                         length(Vec3d{c[0].z, c[1].z, c[2].z})};
        return {place.centre - half, place.centre + half};
    }
    const Placement at(worldFromObject, place);
    Box3d box;
    for (int corner = 0; corner < 8; ++corner) box.add(world(i, at, shape.box.corner(corner)));
    return box;
}

Box3d Geometry::Impl::worldBox(std::uint32_t i) const {
    const Box3d rest = boxAt(i, instances[i].worldFromObject);
    return instances[i].motion ? instances[i].motion->box(rest) : rest;
}

template <class Visitor>
void Geometry::Impl::visitInstances(const LocalRay& ray, float time, Visitor& visitor) const {
    for (const std::uint32_t plane : planes) visitor.visitInstance(plane);
    if (!tree) return;
    const RayInterval part =
        clip(ray, bounds, EmbreeTree::margin / frame.scale, {0, visitor.end()});
    const double speed = length(ray.direction);
    if (part.empty() || !(speed > 0)) return;
    visitor.from = part.from;
    visitor.perUnit = speed * frame.scale;
    tree.traverse({frame.point(ray.at(part.from)), ray.direction * (1 / speed),
                   (part.to - part.from) * visitor.perUnit, time},
                  visitor);
}

struct Geometry::Impl::NearestVisitor final : BoxVisitor {
    const Impl& impl;
    const LocalRay& ray;
    float time;
    const SurfaceHit* left;
    NearestSurface nearest;
    double from = 0, perUnit = 1;  ///< of the tree's ray: where it begins, its units in one of t

    NearestVisitor(const Impl& i, const LocalRay& r, float u, double tMax, const SurfaceHit* l)
        : impl(i), ray(r), time(u), left(l) {
        nearest.t = tMax;
    }
    double end() const { return nearest.t + nearest.slack; }
    void visitInstance(std::uint32_t i) { impl.meet(i, ray, time, left, nearest); }
    double visit(std::uint32_t box) override {
        visitInstance(impl.finite[box]);
        return (end() - from) * perUnit;
    }
};

struct Geometry::Impl::EnclosingVisitor final : BoxVisitor {
    const Impl& impl;
    Vec3d point;
    float time;
    const std::vector<bool>& closed;
    std::vector<std::uint32_t> found;
    double from = 0, perUnit = 1;

    EnclosingVisitor(const Impl& i, Vec3d p, float u, const std::vector<bool>& c)
        : impl(i), point(p), time(u), closed(c) {}
    double end() const { return 0; }  // boxes around the point alone
    void visitInstance(std::uint32_t i) {
        const std::uint32_t object = impl.instances[i].object;
        if (object < closed.size() && closed[object] && impl.encloses(i, point, time))
            found.push_back(i);
    }
    double visit(std::uint32_t box) override {
        visitInstance(impl.finite[box]);
        return 0;
    }
};

void Geometry::Impl::meet(std::uint32_t i, const LocalRay& worldRay, float time,
                          const SurfaceHit* left, NearestSurface& nearest) const {
    const PreparedShape& shape = shapeOf(i);
    const Placement at = placed(i, time);
    const double tMax = nearest.t + nearest.slack;
    Vec3d outwards;  // normal of the shape that the ray starts on
    bool leaves = false;
    if (left && shape.kind != PreparedShape::Kind::Mesh) {
        if (left->instance == i) {
            leaves = true, outwards = left->normal;
        } else if (left->coincident.any) {
            if (const auto start = passesThrough(LocalHit(*this, *left, i))) {
                leaves = true;
                outwards = start->facing == 0  ? start->normal
                           : start->facing > 0 ? left->normal
                                               : -left->normal;
            }
        }
    }
    std::optional<double> t;
    LocalRay ray;
    MeshPoint point;
    switch (shape.kind) {
        case PreparedShape::Kind::Mesh:
            ray = at->localRay(worldRay);
            if (const std::optional<MeshPoint> met = meetMesh(i, ray, tMax, left)) {
                point = *met;
                t = point.t;
            }
            break;
        case PreparedShape::Kind::Sphere:
            ray = at->localRay(worldRay);
            if (!leaves)
                t = meetSphere(ray, tMax);
            else if (dot(worldRay.direction, outwards) < 0)
                t = crossSphere(ray);
            break;
        case PreparedShape::Kind::Disk:
        case PreparedShape::Kind::Plane:
            if (leaves) break;
            ray = at->localRay(worldRay);
            t = meetPlane(ray, tMax);
            if (t && shape.kind == PreparedShape::Kind::Disk) {
                const Vec3d p = ray.at(*t);
                if (!(p.x * p.x + p.z * p.z <= 1)) t.reset();
            }
    }
    if (!t || !(*t < tMax)) return;
    const double slack = slackOf(i, *at, worldRay, ray, *t, point);
    const bool nearer = *t < nearest.t;
    const bool coincident =
        nearest.found && std::abs(*t - nearest.t) <= std::max(slack, nearest.slack);
    if (!nearer) {
        nearest.coincident = nearest.coincident || coincident;
        return;
    }
    nearest = {true, *t, slack, coincident || point.coincident, i, point};
}

std::optional<MeshPoint> Geometry::Impl::meetMesh(std::uint32_t i, const LocalRay& ray, double tMax,
                                                  const SurfaceHit* left) const {
    const FramedMesh& mesh = *shapeOf(i).mesh;
    std::optional<std::uint32_t> triangle;
    if (left && left->instance == i) triangle = left->primitive;
    if (!left || !left->coincident.any) return mesh.nearest(ray, tMax, triangle);
    const LocalHit start(*this, *left, i);
    const auto isLeft = [&](std::uint32_t other, const Triangle& corners) {
        return passesThrough(start, other, corners).has_value();
    };
    return mesh.nearest(ray, tMax, triangle, std::cref(isLeft));
}

bool Geometry::Impl::encloses(std::uint32_t i, Vec3d point, float time) const {
    const PreparedShape& shape = shapeOf(i);
    const Vec3d p = placed(i, time)->localPoint(point);
    switch (shape.kind) {
        case PreparedShape::Kind::Sphere:
            return dot(p, p) < 1;
        case PreparedShape::Kind::Plane:
            return p.y < 0;
        case PreparedShape::Kind::Disk:
            return false;
        case PreparedShape::Kind::Mesh:
            return shape.mesh->encloses(p);
    }
    return false;
}

void Geometry::Impl::complete(const NearestSurface& nearest, const LocalRay& worldRay, float time,
                              SurfaceHit& hit) const {
    const std::uint32_t i = nearest.instance;
    const Placement at = placed(i, time);
    hit.t = nearest.t;
    hit.time = time;
    hit.instance = i;
    hit.primitive = nearest.point.triangle;
    hit.object = instances[i].object;
    if (shapeOf(i).kind == PreparedShape::Kind::Mesh) {
        // A ray that leaves from the very edge could pass between two triangles in floats.
        const Triangle triangle = shapeOf(i).mesh->triangle(hit.primitive);
        const auto& weights = nearest.point.weights;
        hit.position = world(i, at, triangle.at(awayFromEdges(triangle, weights, floatError)));
        completeMesh(at, triangle, weights, hit);
    } else {
        Vec3d p = at->localRay(worldRay).at(hit.t);
        if (shapeOf(i).kind == PreparedShape::Kind::Sphere)
            p = normalize(p);
        else
            p.y = 0;
        hit.position = world(i, at, p);
        completeShape(at, p, hit);
    }
    hit.coincident = {};
    if (!nearest.coincident) return;
    hit.coincident.any = true;
    hit.coincident.reach = reach(i, *at, hit);
}

/// Completes a hit on a shape that is not a mesh, at a point of its own frame.
void Geometry::Impl::completeShape(const Placement& at, Vec3d p, SurfaceHit& hit) const {
    if (shapeOf(hit.instance).kind == PreparedShape::Kind::Sphere) {
        hit.normal = at->worldNormal(p);
        const double longitude = std::atan2(-p.z, p.x) / (2 * pi);
        hit.u = longitude < 0 ? longitude + 1 : longitude;
        hit.v = 0.5 + std::asin(std::clamp(p.y, -1.0, 1.0)) / pi;
    } else {
        hit.normal = at->worldNormal({0, 1, 0});
        // The texture covers the square around a disk.
        const bool disk = shapeOf(hit.instance).kind == PreparedShape::Kind::Disk;
        hit.u = disk ? (1 + p.x) / 2 : p.x;
        hit.v = disk ? (1 - p.z) / 2 : -p.z;
    }
    hit.shadingNormal = hit.normal;
}

void Geometry::Impl::completeMesh(const Placement& at, const Triangle& triangle,
                                  const std::array<double, 3>& w, SurfaceHit& hit) const {
    const mesh::SurfaceMesh& mesh = shapeOf(hit.instance).mesh->mesh();
    const std::uint32_t primitive = hit.primitive;
    hit.normal = at->worldNormal(triangle.normal);
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
    // In some files normals point against the triangles.
    if (dot(sum, triangle.normal) < 0) interpolated = -interpolated;
    Vec3d n = at->worldNormal(interpolated);
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
bool Geometry::moves() const { return impl_->moves; }

bool Geometry::intersect(Vec3d origin, Vec3d direction, double tMax, const SurfaceHit* left,
                         SurfaceHit& hit, float time) const {
    if (!isFinite(origin) || !isFinite(direction)) return false;
    const LocalRay ray{origin, direction};
    Impl::NearestVisitor visitor(*impl_, ray, time, tMax, left);
    impl_->visitInstances(ray, time, visitor);
    if (visitor.nearest.found) impl_->complete(visitor.nearest, ray, time, hit);
    return visitor.nearest.found;
}

std::vector<std::uint32_t> Geometry::enclosing(Vec3d point, const std::vector<bool>& closed,
                                               float time) const {
    if (!isFinite(point)) return {};
    Impl::EnclosingVisitor visitor(*impl_, point, time, closed);
    impl_->visitInstances({point, {0, 0, 1}}, time, visitor);
    std::sort(visitor.found.begin(), visitor.found.end());
    return std::move(visitor.found);
}

std::size_t Geometry::memoryBytes() const {
    return (impl_->device ? impl_->device->memoryBytes() : 0) +
           impl_->instances.capacity() * sizeof(ShapeInstance) +
           impl_->places.capacity() * sizeof(InstancePlace) +
           impl_->finite.capacity() * sizeof(std::uint32_t);
}

}  // namespace woodcock::surface
