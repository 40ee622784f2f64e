// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/nested_media.h"

#include <algorithm>
#include <tuple>

#include "woodcock/base/error.h"

namespace woodcock::render {

void MediumStack::enter(std::uint32_t instance) {
    const auto end = instances_.begin() + count_;
    if (std::find(instances_.begin(), end, instance) != end) return;
    if (count_ == capacity)
        throw inputError(
            "more than {} closed surfaces (glass, interfaces) overlap at one point; let fewer of "
            "them "
            "overlap",
            capacity);
    instances_[count_++] = instance;
}

void MediumStack::leave(std::uint32_t instance) {
    const auto end = instances_.begin() + count_;
    const auto found = std::find(instances_.begin(), end, instance);
    if (found == end) return;  // the path started inside, or rounding hid the entry
    *found = instances_[--count_];
}

namespace {

std::uint8_t shiningSides(std::span<const surface::Material> materials, std::uint32_t index) {
    if (const auto* emissive = std::get_if<surface::EmissiveMaterial>(&materials[index]))
        return emissive->bothSides ? 2 : 1;
    if (const auto* mix = std::get_if<surface::MixMaterial>(&materials[index]))
        return std::max(shiningSides(materials, mix->first), shiningSides(materials, mix->second));
    return 0;
}

bool isOpaque(const surface::Material& material) {
    return std::holds_alternative<surface::DiffuseMaterial>(material) ||
           std::holds_alternative<surface::ConductorMaterial>(material) ||
           std::holds_alternative<surface::EmissiveMaterial>(material);
}

bool hasHoles(std::span<const surface::Material> materials, std::uint32_t index) {
    const auto* mix = std::get_if<surface::MixMaterial>(&materials[index]);
    return mix && (std::holds_alternative<surface::InterfaceMaterial>(materials[mix->first]) ||
                   std::holds_alternative<surface::InterfaceMaterial>(materials[mix->second]));
}

}  // namespace

NestedMedia::NestedMedia(const Scene& scene)
    : set_(*scene.surfaces), holds_(scene.surfaces->holdsMedium()) {
    for (const surface::SurfaceObject& object : set_.objects) {
        anyHolds_ |= object.holdsMedium;
        anyInvisible_ |= !object.cameraVisible;
        shines_.push_back(shiningSides(set_.materials, object.material));
        opaque_.push_back(!object.holdsMedium && isOpaque(set_.materials[object.material]));
        sheet_.push_back(!object.holdsMedium && hasHoles(set_.materials, object.material));
    }
}

std::uint32_t NestedMedia::filling(const MediumStack& inside) const {
    std::uint32_t best = outside;
    for (const std::uint32_t instance : inside.instances()) {
        const auto rank = [&](std::uint32_t i) {
            const std::uint32_t object = set_.geometry.instances()[i].object;
            return std::tuple(set_.objects[object].priority, object, i);
        };
        if (best == outside || rank(instance) > rank(best)) best = instance;
    }
    return best;
}

double NestedMedia::ior(std::uint32_t instance) const {
    return instance == outside ? 1 : objectOf(instance).ior;
}

std::uint32_t NestedMedia::medium(const MediumStack& inside) const {
    const std::uint32_t instance = filling(inside);
    return instance == outside ? 0 : objectOf(instance).medium;
}

Crossing NestedMedia::cross(const MediumStack& inside, Vec3d direction,
                            const surface::SurfaceHit& hit) const {
    const bool holds = holds_[hit.object];
    const bool entering = dot(direction, hit.normal) < 0;
    MediumStack near = inside, beyond = inside;
    surface::BsdfPoint point{hit.normal, hit.shadingNormal, hit.u, hit.v, 1, 1};
    bool hidden = false;
    if (holds && hit.coincident.any) {
        std::vector<surface::CoincidentSurface> surfaces;
        set_.geometry.coincidentSurfaces(hit, surfaces);
        crossLayer(hit, surfaces, direction, near, beyond);
        const std::uint32_t from = filling(near), to = filling(beyond);
        hidden = from == to;
        point.iorOutside = ior(entering ? from : to);
        point.iorInside = ior(entering ? to : from);
    } else if (holds) {
        // As if the ray just entered or left it, whatever the stack says.
        if (entering)
            near.leave(hit.instance), beyond.enter(hit.instance);
        else
            near.enter(hit.instance), beyond.leave(hit.instance);
        const std::uint32_t from = filling(near), to = filling(beyond);
        hidden = from == to;
        point.iorOutside = ior(entering ? from : to);
        point.iorInside = ior(entering ? to : from);
    } else if (!inside.empty()) {
        // An opaque surface in water: no light gets through, whatever its index.
        point.iorOutside = point.iorInside = ior(filling(inside));
    }
    surface::Bsdf bsdf(set_.materials, objectOf(hit.instance).material, point);
    const bool passes = hidden || bsdf.passes();
    return {near, beyond, std::move(bsdf), passes};
}

bool NestedMedia::nearest(const SurfaceQuery& ray, const RayStart& start,
                          surface::SurfaceHit& hit) const {
    const surface::SurfaceHit* left = start.left ? &*start.left : nullptr;
    if (left && left->coincident.any &&
        nextLayer(*left, ray.direction, start.inside, ray.cameraRay, hit))
        return hit.t < ray.tMax;
    if (!set_.geometry.intersect(ray.origin, ray.direction, ray.tMax, left, hit, ray.time))
        return false;
    double travelled = 0;
    while (true) {
        if (hit.coincident.any) {
            const surface::SurfaceHit place = hit;
            if (nextLayer(place, ray.direction, start.inside, ray.cameraRay, hit)) {
                hit.t = place.t;
                break;
            }
        } else if (!ray.cameraRay || !anyInvisible_ || object(hit).cameraVisible) {
            break;
        }
        travelled += hit.t;
        const surface::SurfaceHit passed = hit;
        if (!set_.geometry.intersect(passed.position, ray.direction, ray.tMax - travelled, &passed,
                                     hit, ray.time))
            return false;
    }
    hit.t += travelled;
    return true;
}

}  // namespace woodcock::render
