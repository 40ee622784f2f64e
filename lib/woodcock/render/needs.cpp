// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/needs.h"

#include "woodcock/medium/look_up.h"
#include "woodcock/render/scene.h"

namespace woodcock::render {

Needs findNeeds(const Scene& scene) {
    Needs n = scene.forcedNeeds;
    Box3d bounds;  // of what scatters
    const auto look = [&](const medium::Medium& medium) {
        for (const medium::MediumPart& p : medium.parts) {
            n.chromatic |= p.chromatic();
            n.scattering |= p.scatters();
        }
        n.overlap |= medium.parts.size() > 1;
        n.emission |= !medium.emission.empty();
        n.motion |= scene.shutter.length() > 0 && medium::moves(medium);
        const Box3d box = medium.worldBounds();
        if (!box.empty()) bounds.add(box.lower), bounds.add(box.upper);
    };
    look(scene.medium);
    for (const medium::Medium& medium : scene.interiorMedia) look(medium);
    n.surfaces |= scene.surfaces != nullptr;
    n.motion |= scene.camera.motion || scene.lights.moves() ||
                (scene.surfaces && scene.surfaces->geometry.moves());
    n.lightSampling |= (n.scattering || n.surfaces) && !scene.lights.sampled().empty();
    // Farther lights shine so evenly along a flight that where it ends will do.
    constexpr double near = 0.1;
    const double reach = bounds.empty() ? 0 : near * length(bounds.size());
    for (int i : scene.lights.local()) {
        const Vec3d p = *scene.lights.traits(i).position;
        n.localLights |=
            n.scattering && length(p - max(bounds.lower, min(bounds.upper, p))) <= reach;
    }
    return n;
}

RenderCounters& RenderCounters::operator+=(const RenderCounters& b) {
    paths += b.paths, scatterings += b.scatterings, shadowRays += b.shadowRays;
    distanceSegments += b.distanceSegments, distanceCollisions += b.distanceCollisions;
    shadowSegments += b.shadowSegments, shadowCollisions += b.shadowCollisions;
    surfaceRays += b.surfaceRays, clamped += b.clamped;
    return *this;
}

namespace {

/// Names of the parts that are used, or of those that are not.
std::string namesOf(const Needs& n, bool used) {
    std::string list;
    const auto tell = [&](bool needed, const char* what) {
        if (needed == used) list += (list.empty() ? "" : ", ") + std::string(what);
    };
    tell(n.chromatic, "three colour channels");
    tell(n.overlap, "overlapping media");
    tell(n.scattering, "scattering");
    tell(n.emission, "emission");
    tell(n.lightSampling, "light sampling");
    tell(n.localLights, "equiangular sampling");
    tell(n.surfaces, "surfaces");
    tell(n.motion, "motion");
    return list;
}

}  // namespace

std::string usedOf(const Needs& needs) {
    const std::string names = namesOf(needs, true);
    return "uses " + (names.empty() ? "absorption only" : names);
}

std::string unusedOf(const Needs& needs) {
    const std::string names = namesOf(needs, false);
    return names.empty() ? "" : "does not need " + names;
}

std::string Needs::describe() const { return usedOf(*this); }

}  // namespace woodcock::render
