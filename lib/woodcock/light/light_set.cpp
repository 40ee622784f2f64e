// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/light_set.h"

#include <algorithm>

namespace woodcock::light {

LightSet::LightSet(std::vector<Light> lights) : lights_(std::move(lights)) {
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        const auto index = static_cast<int>(i);
        const LightTraits& traits = traits_.emplace_back(lights_[i].traits());
        if (traits.sampled) sampled_.push_back(index);
        if (traits.position) local_.push_back(index);
        if (traits.distant) distant_.push_back(index);
        if (lights_[i].meetsRays()) meetable_.push_back(index);
        if (std::holds_alternative<MeshLight>(lights_[i])) mesh_ = index;
    }
}

const MeshLight* LightSet::mesh() const {
    return mesh_ < 0 ? nullptr : &std::get<MeshLight>(lights_[static_cast<std::size_t>(mesh_)]);
}

void LightSet::pickProbabilities(const ScatterPoint& at, std::span<float> probabilities) const {
    if (sampled_.size() == 1) {
        probabilities[0] = 1;
        return;
    }
    double total = 0;
    for (std::size_t i = 0; i < sampled_.size(); ++i) {
        const double p = (*this)[sampled_[i]].importance(at);
        probabilities[i] = static_cast<float>(std::min(p, 1e30));
        total += probabilities[i];
    }
    for (float& p : probabilities) p = total > 0 ? static_cast<float>(p / total) : 0;
}

Rgb LightSet::distantRadiance(int light, Vec3d direction, bool cameraRay) const {
    const LightTraits& t = traits(light);
    return t.distant && (t.visible || !cameraRay) ? (*this)[light].distantRadiance(direction)
                                                  : Rgb();
}

bool LightSet::showsBackground() const {
    return std::any_of(traits_.begin(), traits_.end(),
                       [](const LightTraits& t) { return t.distant && t.visible; });
}

float LightSet::typicalRadiance(const Box3d& bounds) const {
    if (bounds.empty()) return 0;
    double sum = 0;
    for (const Light& light : lights_) sum += light.typicalRadiance(bounds);
    return static_cast<float>(sum);
}

}  // namespace woodcock::light
