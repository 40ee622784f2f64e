// SPDX-License-Identifier: Apache-2.0
#include "woodcock/surface/geometry.h"

#if WOODCOCK_EMBREE == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <type_traits>

#include "woodcock/base/error.h"
#include "woodcock/surface/geometry_solve.h"

// Each instance is one primitive of Embree's user geometry, so that a million of them need little
// memory. What a ray meets of it is found in the frame of its shape, of about unit size: floats
// are then as precise as the shape is large, wherever in the world it stands. Embree finds
// candidates; each is decided on in double, along the ray itself and with no offset.

namespace woodcock {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// By how much boxes are larger than what is in them, and rays begin before their origin, in a
/// frame of about unit size: far more than what floats lose, so that nothing is missed.
constexpr double margin = 0x1p-18;

#if WOODCOCK_EMBREE == 4
using EmbreeContext = RTCRayQueryContext;
void initContext(EmbreeContext& context) { rtcInitRayQueryContext(&context); }
void traverse(RTCScene scene, EmbreeContext& context, RTCRayHit& ray) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    rtcIntersect1(scene, &ray, &arguments);
}
#else
using EmbreeContext = RTCIntersectContext;
void initContext(EmbreeContext& context) { rtcInitIntersectContext(&context); }
void traverse(RTCScene scene, EmbreeContext& context, RTCRayHit& ray) {
    rtcIntersect1(scene, &context, &ray);
}
#endif

struct SceneDeleter {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, SceneDeleter>;
struct DeviceDeleter {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
using DeviceHandle = std::unique_ptr<std::remove_pointer_t<RTCDevice>, DeviceDeleter>;

/// A box moved to the origin and scaled to about unit size, by a power of two, which is exact.
struct Frame {
    Vec3d centre;
    double scale = 1;

    Frame() = default;
    explicit Frame(const Box3d& box) {
        if (box.empty()) return;
        centre = box.lower * 0.5 + box.upper * 0.5;
        const Vec3d size = box.size();
        const double largest = std::max({size.x, size.y, size.z});
        if (largest > 0) scale = std::ldexp(1.0, std::clamp(-std::ilogb(largest), -1000, 1000));
    }
    Vec3d point(Vec3d p) const { return (p - centre) * scale; }
};

/// A shape in its own frame, and Embree's tree of it where it is a mesh.
struct Prepared {
    enum class Kind { Sphere, Disk, Plane, Mesh } kind = Kind::Mesh;
    const SurfaceMesh* mesh = nullptr;
    Frame frame;
    Box3d box;  ///< in its frame; empty where there is nothing of finite size
    SceneHandle scene;

    Triangle triangle(std::uint32_t primitive) const {
        const auto& corners = mesh->mesh.triangles[primitive];
        const auto corner = [&](std::size_t i) {
            return frame.point(mesh->mesh.points[corners[i]].as<double>());
        };
        return Triangle({corner(0), corner(1), corner(2)});
    }
};

using Columns = std::array<Vec3d, 3>;
Vec3d times(const Columns& m, Vec3d v) { return m[0] * v.x + m[1] * v.y + m[2] * v.z; }
Vec3d timesTransposed(const Columns& m, Vec3d v) {
    return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}

/// A ray as Embree takes it, from `margin` before the ray's point at `from` on.
RTCRayHit embreeRay(Vec3d from, Vec3d unitDirection, double distance) {
    RTCRayHit r{};
    const Vec3f o = (from - unitDirection * margin).as<float>();
    const Vec3f d = unitDirection.as<float>();
    r.ray.org_x = o.x, r.ray.org_y = o.y, r.ray.org_z = o.z;
    r.ray.dir_x = d.x, r.ray.dir_y = d.y, r.ray.dir_z = d.z;
    r.ray.tfar = static_cast<float>(distance + 3 * margin);
    r.ray.mask = ~0u;
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return r;
}

/// What is looked for among the instances; Embree hands its address on.
struct Query {
    EmbreeContext embree;
    const void* impl = nullptr;
    void (*visit)(Query&, std::uint32_t primitive) = nullptr;
    LocalRay ray;        ///< in world space
    double tMax = 0;     ///< the nearest so far
    double from = 0;     ///< where Embree's ray begins
    double perUnit = 1;  ///< lengths of Embree's ray in one unit of t
};

struct NearestQuery : Query {
    const SurfaceHit* left = nullptr;
    bool found = false;
    std::uint32_t instance = 0, primitive = 0;
    std::array<double, 3> weights{};
};

struct EnclosingQuery : Query {
    const std::vector<bool>* closed = nullptr;
    std::vector<std::uint32_t>* instances = nullptr;
};

/// What is looked for among the triangles of one instance.
struct MeshQuery {
    EmbreeContext embree;
    bool (*accept)(MeshQuery&, std::uint32_t primitive) = nullptr;
    const Prepared* shape = nullptr;
    LocalRay ray;  ///< in the shape's frame, from its point at `from` on
    double from = 0;
};

struct NearestTriangle : MeshQuery {
    double tMax = 0;
    bool starts = false;  ///< on the triangle `left`, to a side of it
    std::uint32_t left = 0;
    double leftSide = 0;  ///< direction . normal there
    double speed = 0;
    bool found = false;
    std::uint32_t primitive = 0;
    std::array<double, 3> weights{};
    double side = 0;  ///< direction . normal of what was found
};

struct Crossings : MeshQuery {
    int leaving = 0;
    bool uncertain = false;
};

bool acceptNearest(MeshQuery& base, std::uint32_t primitive) {
    auto& query = static_cast<NearestTriangle&>(base);
    if (query.starts && primitive == query.left) return false;
    const Triangle triangle = query.shape->triangle(primitive);
    const std::optional<TrianglePoint> point = meetTriangle(query.ray, triangle);
    if (!point) return false;
    const double t = query.from + point->t;
    if (!(t > 0) || !(t < query.tMax)) return false;
    // Beside the edge that the ray starts at, and where it passes one, only the side can tell a hit
    // from what rounding makes of none: who starts inside can only leave, and the other way round.
    const bool doubtful = point->edge < 0 || t * query.speed < 4 * point->tolerance;
    const double side = dot(query.ray.direction, triangle.normal);
    if (query.starts && doubtful && side * query.leftSide > 0) return false;
    query.tMax = t;
    query.found = true;
    query.primitive = primitive;
    query.weights = point->weights;
    query.side = side;
    return true;
}

bool countCrossing(MeshQuery& base, std::uint32_t primitive) {
    auto& query = static_cast<Crossings&>(base);
    const Triangle triangle = query.shape->triangle(primitive);
    const std::optional<TrianglePoint> point = meetTriangle(query.ray, triangle);
    if (!point) return false;
    if (!(point->t > 0)) return false;
    query.uncertain = query.uncertain || point->edge < 2 * point->tolerance;
    query.leaving += dot(query.ray.direction, triangle.normal) > 0 ? 1 : -1;
    return false;
}

void filterTriangle(const RTCFilterFunctionNArguments* a) {
    if (a->valid[0] == 0) return;
    auto& query = *reinterpret_cast<MeshQuery*>(a->context);
    if (!query.accept(query, RTCHitN_primID(a->hit, a->N, 0))) a->valid[0] = 0;
}

void visitInstance(const RTCIntersectFunctionNArguments* a) {
    if (a->valid[0] == 0) return;
    auto& query = *reinterpret_cast<Query*>(a->context);
    const double before = query.tMax;
    query.visit(query, a->primID);
    if (query.tMax == before) return;
    auto& found = *reinterpret_cast<RTCRayHit*>(a->rayhit);
    const double distance = (query.tMax - query.from) * query.perUnit + 3 * margin;
    found.ray.tfar = std::min(found.ray.tfar, static_cast<float>(distance));
    found.hit.geomID = a->geomID;
    found.hit.primID = a->primID;
}

}  // namespace

struct Geometry::Impl {
    std::vector<Shape> shapes;
    std::vector<ShapeInstance> instances;
    std::vector<Prepared> prepared;     ///< of each shape
    std::vector<Columns> localOfWorld;  ///< of each instance: directions to its shape's frame
    std::vector<std::uint32_t> finite, planes;
    Box3d bounds;
    Frame frame;
    std::atomic<std::ptrdiff_t> embreeBytes{0};
    DeviceHandle device;
    SceneHandle scene;  ///< of instances

    Impl(std::vector<Shape> s, std::vector<ShapeInstance> i);
    // Scenes before their device.
    ~Impl() { scene.reset(), prepared.clear(); }

    void requireDevice();
    void requireNoError() const;
    void prepareShape(const Shape& shape);
    void prepareMesh(Prepared& shape);
    void placeInstance(std::uint32_t i);
    void buildInstances();

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
    Box3d worldBox(std::uint32_t i) const;

    void traverseInstances(Query& query) const;
    void visitNearest(NearestQuery& query, std::uint32_t i) const;
    void visitEnclosing(EnclosingQuery& query, std::uint32_t i) const;
    void nearestOfMesh(NearestQuery& query, std::uint32_t i, const LocalRay& ray) const;
    void complete(const NearestQuery& query, SurfaceHit& hit) const;
    void completeMesh(const NearestQuery& query, SurfaceHit& hit) const;
};

Geometry::Impl::Impl(std::vector<Shape> s, std::vector<ShapeInstance> i)
    : shapes(std::move(s)), instances(std::move(i)) {
    for (const Shape& shape : shapes) prepareShape(shape);
    localOfWorld.reserve(instances.size());
    for (std::uint32_t n = 0; n < instances.size(); ++n) placeInstance(n);
    frame = Frame(bounds);
    if (!finite.empty()) buildInstances();
}

void Geometry::Impl::requireDevice() {
    if (device) return;
    device.reset(rtcNewDevice(nullptr));
    if (!device) throw failure("Embree does not start (error {})", int{rtcGetDeviceError(nullptr)});
    rtcSetDeviceMemoryMonitorFunction(
        device.get(),
        [](void* bytes, ssize_t change, bool) {
            *static_cast<std::atomic<std::ptrdiff_t>*>(bytes) += change;
            return true;
        },
        &embreeBytes);
}

void Geometry::Impl::requireNoError() const {
    const RTCError error = rtcGetDeviceError(device.get());
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        throw failure("there is too little memory for the scene's surfaces");
    if (error != RTC_ERROR_NONE) throw failure("Embree fails with error {}", int{error});
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
    } else {
        p.mesh = std::get<std::shared_ptr<const SurfaceMesh>>(shape).get();
        if (!p.mesh->mesh.triangles.empty()) prepareMesh(p);
    }
}

void Geometry::Impl::prepareMesh(Prepared& shape) {
    const TriangleMesh& mesh = shape.mesh->mesh;
    const Box3d box = boundsOf(mesh);
    shape.frame = Frame(box);
    shape.box = {shape.frame.point(box.lower), shape.frame.point(box.upper)};

    requireDevice();
    const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), mesh.points.size()));
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               mesh.triangles.data(), 0, sizeof mesh.triangles[0],
                               mesh.triangles.size());
    if (points)
        for (const Vec3f& p : mesh.points)
            *points++ = shape.frame.point(p.as<double>()).as<float>();
    rtcSetGeometryIntersectFilterFunction(geometry, filterTriangle);
    rtcCommitGeometry(geometry);
    shape.scene.reset(rtcNewScene(device.get()));
    rtcSetSceneFlags(shape.scene.get(), RTC_SCENE_FLAG_ROBUST);
    rtcAttachGeometry(shape.scene.get(), geometry);
    rtcReleaseGeometry(geometry);
    requireNoError();
    rtcCommitScene(shape.scene.get());
    requireNoError();
}

void Geometry::Impl::placeInstance(std::uint32_t i) {
    const ShapeInstance& instance = instances[i];
    const Prepared& shape = prepared.at(instance.shape);
    const Affine3d& m = instance.worldFromObject;
    Columns inverse = Affine3d{m.column, {}}.inverse().column;
    for (Vec3d& column : inverse) column = column * shape.frame.scale;
    const double sides = length(m.column[0]) * length(m.column[1]) * length(m.column[2]);
    bool finiteInverse = true;
    for (const Vec3d& column : inverse) finiteInverse = finiteInverse && isFinite(column);
    constexpr double flat = 1e-14;
    if (!std::isfinite(sides) || !isFinite(m.translation))
        throw inputError("the transform of instance {} (object {}) is not finite", i,
                         instance.object);
    if (!finiteInverse || !(std::abs(m.determinant()) > flat * sides))
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
    Box3d box;
    if (shape.kind == Prepared::Kind::Sphere) {
        const Columns& c = instances[i].worldFromObject.column;
        const Vec3d half{length(Vec3d{c[0].x, c[1].x, c[2].x}),
                         length(Vec3d{c[0].y, c[1].y, c[2].y}),
                         length(Vec3d{c[0].z, c[1].z, c[2].z})};
        return {centre(i) - half, centre(i) + half};
    }
    for (int corner = 0; corner < 8; ++corner) box.add(world(i, shape.box.corner(corner)));
    return box;
}

void Geometry::Impl::buildInstances() {
    requireDevice();
    const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(finite.size()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryIntersectFunction(geometry, visitInstance);
    rtcSetGeometryBoundsFunction(
        geometry,
        [](const RTCBoundsFunctionArguments* a) {
            const Impl& impl = *static_cast<const Impl*>(a->geometryUserPtr);
            const Box3d box = impl.worldBox(impl.finite[a->primID]);
            const Vec3d m{margin, margin, margin};
            const Vec3f lower = (impl.frame.point(box.lower) - m).as<float>();
            const Vec3f upper = (impl.frame.point(box.upper) + m).as<float>();
            *a->bounds_o = {lower.x, lower.y, lower.z, 0, upper.x, upper.y, upper.z, 0};
        },
        this);
    rtcCommitGeometry(geometry);
    scene.reset(rtcNewScene(device.get()));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    rtcAttachGeometry(scene.get(), geometry);
    rtcReleaseGeometry(geometry);
    requireNoError();
    rtcCommitScene(scene.get());
    requireNoError();
}

void Geometry::Impl::traverseInstances(Query& query) const {
    if (!scene) return;
    const RayInterval part = clip(query.ray, bounds, margin / frame.scale, {0, query.tMax});
    if (part.empty()) return;
    const double speed = length(query.ray.direction);
    if (!(speed > 0)) return;
    query.from = part.from;
    query.perUnit = speed * frame.scale;
    RTCRayHit ray =
        embreeRay(frame.point(query.ray.at(part.from)), query.ray.direction * (1 / speed),
                  (part.to - part.from) * query.perUnit);
    initContext(query.embree);
    traverse(scene.get(), query.embree, ray);
}

void Geometry::Impl::visitNearest(NearestQuery& query, std::uint32_t i) const {
    const Prepared& shape = shapeOf(i);
    const LocalRay ray = local(i, query.ray);
    if (shape.kind == Prepared::Kind::Mesh) return nearestOfMesh(query, i, ray);
    const bool starts = query.left && query.left->instance == i;
    std::optional<double> t;
    if (shape.kind == Prepared::Kind::Sphere) {
        if (!starts)
            t = meetSphere(ray, query.tMax);
        else if (dot(query.ray.direction, query.left->normal) < 0)
            t = crossSphere(ray);
    } else if (!starts) {
        t = meetPlane(ray, query.tMax);
        if (t && shape.kind == Prepared::Kind::Disk) {
            const Vec3d p = ray.at(*t);
            if (!(p.x * p.x + p.z * p.z <= 1)) t.reset();
        }
    }
    if (!t || !(*t < query.tMax)) return;
    query.tMax = *t;
    query.found = true;
    query.instance = i;
    query.primitive = 0;
}

void Geometry::Impl::nearestOfMesh(NearestQuery& query, std::uint32_t i,
                                   const LocalRay& ray) const {
    const Prepared& shape = shapeOf(i);
    const RayInterval part = clip(ray, shape.box, margin, {0, query.tMax});
    if (part.empty()) return;
    NearestTriangle inner;
    inner.accept = acceptNearest;
    inner.shape = &shape;
    inner.ray = {ray.at(part.from), ray.direction};
    inner.from = part.from;
    inner.tMax = query.tMax;
    inner.speed = length(ray.direction);
    if (!(inner.speed > 0)) return;
    if (query.left && query.left->instance == i) {
        inner.starts = true;
        inner.left = query.left->primitive;
        inner.leftSide = dot(ray.direction, shape.triangle(inner.left).normal);
    }
    const Vec3d direction = ray.direction * (1 / inner.speed);
    const auto search = [&](Vec3d origin) {
        RTCRayHit embree = embreeRay(origin, direction, (part.to - part.from) * inner.speed);
        initContext(inner.embree);
        traverse(shape.scene.get(), inner.embree, embree);
    };
    search(inner.ray.origin);
    // Who leaves almost along the surface, beside an edge, may be on its other side for floats.
    // Then nothing is met of a mesh that is closed, or what is met is met from the wrong side.
    if (inner.starts && (inner.found ? inner.side * inner.leftSide > 0 : inner.leftSide < 0)) {
        const Vec3d normal = normalize(shape.triangle(inner.left).normal);
        search(inner.ray.origin + normal * std::copysign(4 * floatError, inner.leftSide));
    }
    if (!inner.found) return;
    query.tMax = inner.tMax;
    query.found = true;
    query.instance = i;
    query.primitive = inner.primitive;
    query.weights = inner.weights;
}

void Geometry::Impl::complete(const NearestQuery& query, SurfaceHit& hit) const {
    const std::uint32_t i = query.instance;
    hit.t = query.tMax;
    hit.instance = i;
    hit.primitive = query.primitive;
    hit.object = instances[i].object;
    const Prepared::Kind kind = shapeOf(i).kind;
    if (kind == Prepared::Kind::Mesh) return completeMesh(query, hit);
    Vec3d p = local(i, query.ray).at(hit.t);
    if (kind == Prepared::Kind::Sphere) {
        p = normalize(p);
        hit.normal = worldNormal(i, p);
        const double longitude = std::atan2(-p.z, p.x) / (2 * pi);
        hit.u = longitude < 0 ? longitude + 1 : longitude;
        hit.v = 0.5 + std::asin(std::clamp(p.y, -1.0, 1.0)) / pi;
    } else {
        p.y = 0;
        hit.normal = worldNormal(i, {0, 1, 0});
        hit.u = p.x, hit.v = p.z;
    }
    hit.shadingNormal = hit.normal;
    hit.position = world(i, p);
}

void Geometry::Impl::completeMesh(const NearestQuery& query, SurfaceHit& hit) const {
    const std::uint32_t i = query.instance;
    const Prepared& shape = shapeOf(i);
    const SurfaceMesh& mesh = *shape.mesh;
    const Triangle triangle = shape.triangle(query.primitive);
    const auto& w = query.weights;
    // Who leaves from the very edge could pass between two triangles, as floats see them.
    hit.position = world(i, triangle.at(awayFromEdges(triangle, w, floatError)));
    hit.normal = worldNormal(i, triangle.normal);
    hit.shadingNormal = hit.normal;
    hit.u = hit.v = 0;
    if (!mesh.uvs.empty()) {
        const auto& uv = mesh.uvs[query.primitive];
        for (std::size_t k = 0; k < 3; ++k) {
            hit.u += w[k] * static_cast<double>(uv[k].u);
            hit.v += w[k] * static_cast<double>(uv[k].v);
        }
    }
    if (mesh.normals.empty()) return;
    Vec3d sum, interpolated;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d n = mesh.normals[query.primitive][k].as<double>();
        sum += n, interpolated += n * w[k];
    }
    // Some files turn their normals against their triangles.
    if (dot(sum, triangle.normal) < 0) interpolated = -interpolated;
    Vec3d n = worldNormal(i, interpolated);
    constexpr double least = 1e-3;  // cosine: bent no further than just above the surface
    const double cosine = dot(n, hit.normal);
    if (cosine < least) n = normalize(n + hit.normal * (least - cosine));
    if (isFinite(n)) hit.shadingNormal = n;
}

namespace {

/// Whether a point is inside of the mesh: more triangles are left through than entered on the way
/// out. A way that passes an edge too closely for floats is taken in another direction.
bool isInside(const Prepared& shape, Vec3d point) {
    if (!shape.box.contains(point)) return false;
    constexpr int ways = 9;
    int inside = 0;
    for (int k = 0; k < ways; ++k) {
        const double y = 1 - (2 * k + 1.0) / ways, azimuth = 0.7 + 2.399963229728653 * k;
        const double r = std::sqrt(1 - y * y);
        Crossings crossings;
        crossings.accept = countCrossing;
        crossings.shape = &shape;
        crossings.ray = {point, {r * std::cos(azimuth), y, r * std::sin(azimuth)}};
        RTCRayHit ray = embreeRay(point, crossings.ray.direction, infinity);
        initContext(crossings.embree);
        traverse(shape.scene.get(), crossings.embree, ray);
        if (!crossings.uncertain) return crossings.leaving > 0;
        inside += crossings.leaving > 0;
    }
    return 2 * inside > ways;
}

}  // namespace

void Geometry::Impl::visitEnclosing(EnclosingQuery& query, std::uint32_t i) const {
    const std::uint32_t object = instances[i].object;
    if (object >= query.closed->size() || !(*query.closed)[object]) return;
    const Prepared& shape = shapeOf(i);
    const Vec3d p = local(i, query.ray).origin;
    const bool inside = shape.kind == Prepared::Kind::Sphere  ? dot(p, p) < 1
                        : shape.kind == Prepared::Kind::Plane ? p.y < 0
                        : shape.kind == Prepared::Kind::Mesh  ? isInside(shape, p)
                                                              : false;
    if (inside) query.instances->push_back(i);
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
    NearestQuery query;
    query.impl = impl_.get();
    query.ray = {origin, direction};
    query.tMax = tMax;
    query.left = left;
    for (const std::uint32_t plane : impl_->planes) impl_->visitNearest(query, plane);
    query.visit = [](Query& q, std::uint32_t primitive) {
        const Impl& impl = *static_cast<const Impl*>(q.impl);
        impl.visitNearest(static_cast<NearestQuery&>(q), impl.finite[primitive]);
    };
    impl_->traverseInstances(query);
    if (query.found) impl_->complete(query, hit);
    return query.found;
}

std::vector<std::uint32_t> Geometry::enclosing(Vec3d point, const std::vector<bool>& closed) const {
    std::vector<std::uint32_t> found;
    if (!isFinite(point)) return found;
    EnclosingQuery query;
    query.impl = impl_.get();
    query.ray = {point, {0, 0, 1}};
    query.closed = &closed;
    query.instances = &found;
    for (const std::uint32_t plane : impl_->planes) impl_->visitEnclosing(query, plane);
    query.visit = [](Query& q, std::uint32_t primitive) {
        const Impl& impl = *static_cast<const Impl*>(q.impl);
        impl.visitEnclosing(static_cast<EnclosingQuery&>(q), impl.finite[primitive]);
    };
    impl_->traverseInstances(query);
    std::sort(found.begin(), found.end());
    return found;
}

std::size_t Geometry::memoryBytes() const {
    return static_cast<std::size_t>(impl_->embreeBytes.load()) +
           impl_->instances.capacity() * sizeof(ShapeInstance) +
           impl_->localOfWorld.capacity() * sizeof(Columns) +
           impl_->finite.capacity() * sizeof(std::uint32_t);
}

}  // namespace woodcock
