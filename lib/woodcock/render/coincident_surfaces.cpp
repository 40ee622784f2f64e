// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include "woodcock/render/nested_media.h"

// Surfaces that coincide have one answer. It depends neither on which of them a ray meets first nor
// on rounding:
//   - Of opaque surfaces, the one of highest rank counts, alone. A sheet with holes of a higher
//     rank lies before it.
//   - Closed surfaces that light can enter touch without a gap: a ray crosses all at once.
//   - A gap of no width parts them from opaque surfaces. So a block of glass on a floor looks as it
//     does a hair above the floor.
// A path goes from layer to layer, by steps of no length.

namespace woodcock::render {

namespace {

/// On which side of the place's first normal the inside of a surface lies: 1 behind it, -1 before
/// it.
double sideOf(const surface::CoincidentSurface& surface, const surface::SurfaceHit& hit) {
    return hit.coincident.turned ? -surface.facing : surface.facing;
}

Vec3d firstNormal(const surface::SurfaceHit& hit) {
    return hit.coincident.turned ? -hit.normal : hit.normal;
}

}  // namespace

/// By priority, then by whether the surface emits towards the side (1: that of the first normal),
/// then by order: later ones rank higher. An emitter of one side counts least from behind, where it
/// is black.
NestedMedia::Rank NestedMedia::rank(const surface::CoincidentSurface& surface, double side) const {
    int light = 1;
    if (const std::uint8_t shines = shines_[surface.object]; shines > 0)
        light = shines == 2 || side > 0 ? 2 : 0;
    return {set_.objects[surface.object].priority, light, surface.object, surface.instance,
            surface.primitive};
}

bool NestedMedia::inLayer(const surface::CoincidentSurface& surface,
                          const surface::SurfaceHit& hit) const {
    if (hit.coincident.forCamera && !set_.objects[surface.object].cameraVisible) return false;
    if (!holds_[surface.object]) return false;
    if (hit.coincident.layer == OneBoundary) return true;
    return (sideOf(surface, hit) > 0) == (hit.coincident.layer == Back);
}

/// What surfaces lie in one place, by kind; and of opaque ones the best, as it is seen from the
/// front (0) and from the back (1).
struct NestedMedia::Place {
    struct Best {
        const surface::CoincidentSurface* surface = nullptr;
        Rank rank;
        void add(const surface::CoincidentSurface& s, const Rank& r) {
            if (!surface || r > rank) surface = &s, rank = r;
        }
    };
    std::array<Best, 2> solid, sheet;
    std::array<bool, 2> interior{};  ///< a closed surface is on this side

    /// Something opaque parts the two sides.
    bool parted() const { return solid[0].surface || sheet[0].surface; }
    bool sheetCounts(std::size_t seenFrom) const {
        return sheet[seenFrom].surface &&
               (!solid[seenFrom].surface || sheet[seenFrom].rank > solid[seenFrom].rank);
    }
    bool has(int layer) const {
        switch (layer) {
            case Front:
                return parted() && interior[0];
            case FrontSheet:
                return sheetCounts(0);
            case Solid:
                return solid[0].surface != nullptr;
            case BackSheet:  // without an opaque surface between, both sides are one sheet
                return solid[0].surface && sheetCounts(1);
            case Back:
                return parted() && interior[1];
            default:
                return !parted() && (interior[0] || interior[1]);
        }
    }
    /// The layer that comes next; NoLayer, or FromCamera, where none does.
    int after(int layer, bool forward) const {
        if (layer == NoLayer && !forward) layer = FromCamera;
        do layer += forward ? 1 : -1;
        while (layer > NoLayer && layer < FromCamera && !has(layer));
        return layer;
    }
};

NestedMedia::Place NestedMedia::placeOf(const surface::SurfaceHit& hit,
                                        std::span<const surface::CoincidentSurface> surfaces,
                                        bool cameraRay) const {
    Place place;
    for (const surface::CoincidentSurface& s : surfaces) {
        if (cameraRay && !set_.objects[s.object].cameraVisible) continue;
        const double side = sideOf(s, hit);
        if (holds_[s.object]) {
            place.interior[side > 0] = true;
            continue;
        }
        for (std::size_t seenFrom = 0; seenFrom < 2; ++seenFrom)
            (sheet_[s.object] ? place.sheet : place.solid)[seenFrom].add(
                s, rank(s, seenFrom == 0 ? side : -side));
    }
    return place;
}

/// The face of the medium that counts on either side of a layer of closed surfaces. Of two, that of
/// higher rank; but glass goes before a mere interface, or fog on glass would take its reflections
/// away.
const surface::CoincidentSurface* NestedMedia::boundaryThatCounts(
    const surface::SurfaceHit& layer, std::span<const surface::CoincidentSurface> surfaces,
    Vec3d direction, const MediumStack& inside) const {
    MediumStack near = inside, beyond = inside;
    crossLayer(layer, surfaces, direction, near, beyond);
    const std::uint32_t from = filling(near), to = filling(beyond);
    const auto order = [&](const surface::CoincidentSurface& c) {
        const bool changes = from != to && (c.instance == from || c.instance == to);
        const bool passes = std::holds_alternative<surface::InterfaceMaterial>(
            set_.materials[set_.objects[c.object].material]);
        return std::tuple(changes, !passes, rank(c, 1));
    };
    const surface::CoincidentSurface* counts = nullptr;
    for (const surface::CoincidentSurface& s : surfaces)
        if (inLayer(s, layer) && (!counts || order(s) > order(*counts))) counts = &s;
    return counts;
}

bool NestedMedia::nextLayer(const surface::SurfaceHit& hit, Vec3d direction,
                            const MediumStack& inside, bool cameraRay,
                            surface::SurfaceHit& next) const {
    if (hit.coincident.layer == OneBoundary || hit.coincident.layer == FromCamera) return false;
    std::vector<surface::CoincidentSurface> all;
    set_.geometry.coincidentSurfaces(hit, all);
    if (all.size() < 2 && hit.coincident.layer == NoLayer &&
        !(cameraRay && !object(hit).cameraVisible)) {
        next = hit;  // the others are neighbours at an edge
        next.coincident = {};
        return true;
    }
    const bool forward = dot(direction, firstNormal(hit)) < 0;
    const Place place = placeOf(hit, all, cameraRay);
    const int layer = place.after(hit.coincident.layer, forward);
    if (layer <= NoLayer || layer >= FromCamera) return false;

    surface::SurfaceHit there = hit;
    there.coincident.layer = static_cast<std::uint8_t>(layer);
    there.coincident.forCamera = cameraRay;
    const surface::CoincidentSurface* counts = nullptr;
    if (layer == Solid || layer == FrontSheet || layer == BackSheet) {
        // A sheet alone may be met from behind.
        const std::size_t seenFrom = layer == BackSheet || (layer == Solid && !forward);
        counts = (layer == Solid ? place.solid : place.sheet)[seenFrom].surface;
    } else {
        counts = boundaryThatCounts(there, all, direction, inside);
    }
    next = set_.geometry.inPlaceOf(there, *counts);
    next.t = std::numeric_limits<double>::min();  // no length, but in front of the ray
    return true;
}

void NestedMedia::crossLayer(const surface::SurfaceHit& hit,
                             std::span<const surface::CoincidentSurface> surfaces, Vec3d direction,
                             MediumStack& near, MediumStack& beyond) const {
    const bool forward = dot(direction, firstNormal(hit)) < 0;
    for (std::size_t i = 0; i < surfaces.size();) {
        // Faces of one body that lie back to back cancel. Those that face the same way are one.
        const std::uint32_t instance = surfaces[i].instance;
        int outwards = 0;
        for (; i < surfaces.size() && surfaces[i].instance == instance; ++i)
            if (inLayer(surfaces[i], hit)) outwards += sideOf(surfaces[i], hit) > 0 ? 1 : -1;
        if (outwards == 0) continue;
        // As if the ray just entered or left it, whatever the stack says.
        if ((outwards > 0) == forward)
            near.leave(instance), beyond.enter(instance);
        else
            near.enter(instance), beyond.leave(instance);
    }
}

bool NestedMedia::startsOn(const surface::SurfaceHit& hit, std::uint32_t emitter) const {
    if (emitter == surface::SurfaceObject::dark) return false;
    if (!hit.coincident.any) return this->emitter(hit) == emitter;
    std::vector<surface::CoincidentSurface> all;
    set_.geometry.coincidentSurfaces(hit, all);
    return std::any_of(all.begin(), all.end(), [&](const surface::CoincidentSurface& s) {
        const std::uint32_t first = set_.firstEmitter[s.instance];
        return first != surface::SurfaceObject::dark && first + s.primitive == emitter;
    });
}

NestedMedia::CameraPosition NestedMedia::cameraPosition(Vec3d position, float time) const {
    CameraPosition start{position, {}, {}, time};
    surface::SurfaceHit place;
    place.position = position;
    place.time = time;
    set_.geometry.coincidentSurfaces(place, start.touched);
    if (!anyHolds_) return start;
    const auto touched = [&](std::uint32_t instance) {
        return std::any_of(
            start.touched.begin(), start.touched.end(),
            [&](const surface::CoincidentSurface& s) { return s.instance == instance; });
    };
    for (const std::uint32_t instance : set_.geometry.enclosing(position, holds_, time))
        if (objectOf(instance).cameraVisible && !touched(instance)) start.inside.enter(instance);
    return start;
}

NestedMedia::RayStart NestedMedia::rayStart(const CameraPosition& start, Vec3d direction) const {
    RayStart place{start.inside, {}};
    if (start.touched.empty()) return place;
    for (std::size_t i = 0; i < start.touched.size();) {
        const std::uint32_t instance = start.touched[i].instance;
        bool inwards = true;  // right for bodies that are convex there
        for (; i < start.touched.size() && start.touched[i].instance == instance; ++i)
            inwards = inwards && dot(direction, start.touched[i].normal) < 0;
        const surface::SurfaceObject& object = objectOf(instance);
        if (inwards && object.holdsMedium && object.cameraVisible) place.inside.enter(instance);
    }
    place.left.emplace();
    place.left->position = start.position;
    place.left->time = start.time;
    place.left->instance = std::numeric_limits<std::uint32_t>::max();
    place.left->coincident.any = true;
    place.left->coincident.layer = FromCamera;
    return place;
}

}  // namespace woodcock::render
