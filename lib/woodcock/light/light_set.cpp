// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/light_set.h"

#include <algorithm>

namespace woodcock::light {

LightSet::LightSet(std::vector<Light> lights, Motions motions, std::vector<std::uint8_t> groups)
    : lights_(std::move(lights)),
      motions_(std::move(motions)),
      moves_(std::any_of(motions_.begin(), motions_.end(),
                         [](const auto& m) { return m != nullptr; })),
      groups_(std::move(groups)) {
    groups_.resize(lights_.size());
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

void LightSet::toRest(const MovingTransform& motion, float time, Vec3d& point, Vec3d& direction) {
    const Affine3d rest = motion.at(double{time}).inverse();
    point = rest.point(point), direction = rest.vector(direction);
}

LightSample LightSet::sampleMoved(int light, const MovingTransform& motion, Vec3d from, double u0,
                                  double u1, float time) const {
    const Affine3d there = motion.at(double{time});
    LightSample s = (*this)[light].sample(there.inverse().point(from), u0, u1);
    s.direction = there.vector(s.direction);
    return s;
}

double LightSet::importance(int light, const ScatterPoint& at) const {
    const auto* motion = motionOf(light);
    if (!motion) return (*this)[light].importance(at);
    ScatterPoint atRest = at;
    toRest(*motion, at.time, atRest.position, atRest.forward);
    return (*this)[light].importance(atRest);
}

void LightSet::pickProbabilities(const ScatterPoint& at, std::span<float> probabilities) const {
    if (sampled_.size() == 1) {
        probabilities[0] = 1;
        return;
    }
    double total = 0;
    for (std::size_t i = 0; i < sampled_.size(); ++i) {
        const double p = importance(sampled_[i], at);
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
