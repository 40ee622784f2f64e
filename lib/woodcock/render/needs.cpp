// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/needs.h"

#include "woodcock/render/scene.h"

namespace woodcock {

Needs findNeeds(const Scene& scene) {
    Needs n;
    for (const MediumPart& p : scene.medium.parts) {
        n.chromatic |= p.chromatic();
        n.scattering |= p.scatters();
    }
    n.overlap = scene.medium.parts.size() > 1;
    n.lightSampling = n.scattering && !scene.lights.sampled().empty();
    const Box3d bounds = scene.medium.worldBounds();
    const double reach = bounds.empty() ? 0 : length(bounds.size());
    for (int i : scene.lights.local()) {
        const Light& light = scene.lights.lights()[static_cast<std::size_t>(i)];
        const auto* point = std::get_if<PointLight>(&light);
        const Vec3d p = point ? point->position : std::get<SphereLight>(light).position;
        n.localLights |=
            n.scattering && length(p - max(bounds.lower, min(bounds.upper, p))) < reach;
    }
    return n;
}

std::string Needs::describe() const {
    std::string with, without;
    const auto tell = [&](bool needed, const char* what) {
        std::string& list = needed ? with : without;
        list += (list.empty() ? "" : ", ") + std::string(what);
    };
    tell(chromatic, "three colour channels");
    tell(overlap, "overlapping media");
    tell(scattering, "scattering");
    tell(lightSampling, "light sampling");
    tell(localLights, "equiangular sampling");
    return "needs " + (with.empty() ? std::string("absorption only") : with) +
           (without.empty() ? "" : "; left out: " + without);
}

}  // namespace woodcock
