// SPDX-License-Identifier: Apache-2.0
#include "woodcock/surface/embree_tree.h"

#if WOODCOCK_EMBREE == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <atomic>
#include <type_traits>

#include "woodcock/base/error.h"

namespace woodcock::surface {

namespace {

#if WOODCOCK_EMBREE == 4
using Context = RTCRayQueryContext;
void initContext(Context& context) { rtcInitRayQueryContext(&context); }
void intersect(RTCScene scene, Context& context, RTCRayHit& ray) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    rtcIntersect1(scene, &ray, &arguments);
}
#else
using Context = RTCIntersectContext;
void initContext(Context& context) { rtcInitIntersectContext(&context); }
void intersect(RTCScene scene, Context& context, RTCRayHit& ray) {
    rtcIntersect1(scene, &context, &ray);
}
#endif

template <auto release>
struct Releaser {
    template <class T>
    void operator()(T* handle) const {
        release(handle);
    }
};
template <class Handle, auto release>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Releaser<release>>;

void requireNoError(RTCDevice device) {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        throw failure("there is not enough memory for the scene's surfaces");
    if (error != RTC_ERROR_NONE) throw failure("Embree fails with error {}", int{error});
}

/// Embree passes the context's address to its callbacks: our own data lie behind it.
template <class Visitor>
struct Query {
    Context context;
    Visitor* visitor = nullptr;
};

template <class Visitor>
void intersect(RTCScene scene, const TreeRay& ray, Visitor& visitor) {
    static_assert(std::is_standard_layout_v<Query<Visitor>>);
    constexpr double margin = EmbreeTree::margin;
    RTCRayHit r{};
    const Vec3f o = (ray.origin - ray.direction * margin).template as<float>();
    const Vec3f d = ray.direction.template as<float>();
    r.ray.org_x = o.x, r.ray.org_y = o.y, r.ray.org_z = o.z;
    r.ray.dir_x = d.x, r.ray.dir_y = d.y, r.ray.dir_z = d.z;
    r.ray.tfar = static_cast<float>(ray.distance + 3 * margin);
    r.ray.time = ray.time;
    r.ray.mask = ~0u;
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    Query<Visitor> query;
    initContext(query.context);
    query.visitor = &visitor;
    intersect(scene, query.context, r);
}

void filterTriangle(const RTCFilterFunctionNArguments* a) {
    if (a->valid[0] == 0) return;
    const auto& query = *reinterpret_cast<Query<TriangleVisitor>*>(a->context);
    if (query.visitor->accept(RTCHitN_primID(a->hit, a->N, 0)))
        // The ray's new end; Embree lets filters move it.
        RTCRayN_tfar(a->ray, a->N, 0) += static_cast<float>(query.visitor->beyond);
    else
        a->valid[0] = 0;
}

void visitBox(const RTCIntersectFunctionNArguments* a) {
    if (a->valid[0] == 0) return;
    const auto& query = *reinterpret_cast<Query<BoxVisitor>*>(a->context);
    const double distance = query.visitor->visit(a->primID) + 3 * EmbreeTree::margin;
    auto& ray = *reinterpret_cast<RTCRayHit*>(a->rayhit);
    if (!(distance < static_cast<double>(ray.ray.tfar))) return;
    ray.ray.tfar = static_cast<float>(std::max(distance, 0.0));
    ray.hit.geomID = a->geomID;
    ray.hit.primID = a->primID;
}

using BoxAtStep = std::function<Box3d(std::uint32_t, std::uint32_t)>;

void boundBox(const RTCBoundsFunctionArguments* a) {
    const Box3d b = (*static_cast<const BoxAtStep*>(a->geometryUserPtr))(a->primID, a->timeStep);
    const Vec3d m{EmbreeTree::margin, EmbreeTree::margin, EmbreeTree::margin};
    const Vec3f lower = (b.lower - m).as<float>(), upper = (b.upper + m).as<float>();
    *a->bounds_o = {lower.x, lower.y, lower.z, 0, upper.x, upper.y, upper.z, 0};
}

}  // namespace

struct EmbreeDevice::Impl {
    std::atomic<std::ptrdiff_t> bytes{0};
    Owned<RTCDevice, rtcReleaseDevice> device;
};

EmbreeDevice::EmbreeDevice() : impl_(std::make_unique<Impl>()) {
    impl_->device.reset(rtcNewDevice(nullptr));
    if (!impl_->device)
        throw failure("Embree does not start: error {}", int{rtcGetDeviceError(nullptr)});
    rtcSetDeviceMemoryMonitorFunction(
        impl_->device.get(),
        [](void* bytes, ssize_t change, bool) {
            *static_cast<std::atomic<std::ptrdiff_t>*>(bytes) += change;
            return true;
        },
        &impl_->bytes);
}
EmbreeDevice::~EmbreeDevice() = default;
EmbreeDevice::EmbreeDevice(EmbreeDevice&&) noexcept = default;
EmbreeDevice& EmbreeDevice::operator=(EmbreeDevice&&) noexcept = default;

std::size_t EmbreeDevice::memoryBytes() const {
    return static_cast<std::size_t>(impl_->bytes.load());
}

struct EmbreeTree::Impl {
    Owned<RTCScene, rtcReleaseScene> scene;

    void build(RTCDevice device, RTCGeometry geometry) {
        rtcCommitGeometry(geometry);
        scene.reset(rtcNewScene(device));
        rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
        rtcAttachGeometry(scene.get(), geometry);
        requireNoError(device);
        rtcCommitScene(scene.get());
        requireNoError(device);
    }
};

EmbreeTree::EmbreeTree() = default;
EmbreeTree::~EmbreeTree() = default;
EmbreeTree::EmbreeTree(EmbreeTree&&) noexcept = default;
EmbreeTree& EmbreeTree::operator=(EmbreeTree&&) noexcept = default;

EmbreeTree::EmbreeTree(const EmbreeDevice& embree, std::size_t points,
                       const std::function<Vec3d(std::size_t)>& point,
                       std::span<const std::array<std::uint32_t, 3>> triangles)
    : impl_(std::make_unique<Impl>()) {
    const RTCDevice device = embree.impl_->device.get();
    const Owned<RTCGeometry, rtcReleaseGeometry> geometry(
        rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
    auto* corners = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
        geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), points));
    if (!corners) requireNoError(device);
    for (std::size_t i = 0; i < points; ++i) corners[i] = point(i).as<float>();
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               triangles.data(), 0, sizeof triangles[0], triangles.size());
    rtcSetGeometryIntersectFilterFunction(geometry.get(), filterTriangle);
    impl_->build(device, geometry.get());
}

EmbreeTree::EmbreeTree(const EmbreeDevice& embree, std::uint32_t boxes,
                       const std::function<Box3d(std::uint32_t)>& box)
    : EmbreeTree(embree, boxes, 1, [&](std::uint32_t index, std::uint32_t) { return box(index); }) {
}

EmbreeTree::EmbreeTree(const EmbreeDevice& embree, std::uint32_t boxes, std::uint32_t steps,
                       const std::function<Box3d(std::uint32_t, std::uint32_t)>& box)
    : impl_(std::make_unique<Impl>()) {
    const RTCDevice device = embree.impl_->device.get();
    const Owned<RTCGeometry, rtcReleaseGeometry> geometry(
        rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER));
    rtcSetGeometryUserPrimitiveCount(geometry.get(), boxes);
    rtcSetGeometryTimeStepCount(geometry.get(), steps);
    // Called while the tree is built, and not after.
    rtcSetGeometryUserData(geometry.get(), const_cast<BoxAtStep*>(&box));
    rtcSetGeometryBoundsFunction(geometry.get(), boundBox, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), visitBox);
    impl_->build(device, geometry.get());
}

void EmbreeTree::traverse(const TreeRay& ray, TriangleVisitor& visitor) const {
    intersect(impl_->scene.get(), ray, visitor);
}

void EmbreeTree::traverse(const TreeRay& ray, BoxVisitor& visitor) const {
    intersect(impl_->scene.get(), ray, visitor);
}

void EmbreeTree::around(Vec3d point, double radius, float time,
                        const std::function<void(std::uint32_t)>& visit) const {
    const Vec3f p = point.as<float>();
    RTCPointQuery query{};
    query.x = p.x, query.y = p.y, query.z = p.z;
    query.time = time;
    query.radius = static_cast<float>(radius + 2 * margin);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    const auto found = [](RTCPointQueryFunctionArguments* a) {
        (*static_cast<const std::function<void(std::uint32_t)>*>(a->userPtr))(a->primID);
        return false;  // the search goes on as far as before
    };
    rtcPointQuery(impl_->scene.get(), &query, &context, found,
                  const_cast<std::function<void(std::uint32_t)>*>(&visit));
}

}  // namespace woodcock::surface
