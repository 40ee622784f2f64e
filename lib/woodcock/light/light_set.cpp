// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/light_set.h"

#include <algorithm>

namespace woodcock::light {

LightSet::LightSet(std::vector<Light> lights, Motions motions, std::vector<std::uint8_t> groups)
    : lights_(std::move(lights)), motions_(std::move(motions)), groups_(std::move(groups)) {
    groups_.resize(lights_.size()), motions_.resize(lights_.size());
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        const auto index = static_cast<int>(i);
        const LightTraits& traits = traits_.emplace_back(lights_[i].traits());
        if (traits.sampled) sampled_.push_back(index);
        if (traits.position) local_.push_back(index);
        if (traits.distant) distant_.push_back(index);
        if (lights_[i].meetsRays()) meetable_.push_back(index);
        if (std::holds_alternative<MeshLight>(lights_[i])) mesh_ = index;
        const bool moves =
            motions_[i].place || motions_[i].form || (mesh_ == index && mesh()->moves());
        if (moves) moving_.resize(lights_.size()), moving_[i] = 1;
    }
}

const MeshLight* LightSet::mesh() const {
    return mesh_ < 0 ? nullptr : &std::get<MeshLight>(lights_[static_cast<std::size_t>(mesh_)]);
}

namespace {

void take(const Affine3d& map, Vec3d& point, Vec3d& direction) {
    point = map.point(point), direction = map.vector(direction);
}

/// What a light in its place at rest, of the form of a time, answers.
template <class Question>
auto askAtRest(const Light& light, const LightMotion& motion, float time, Question&& question) {
    return motion.form ? question(light.withForm(motion.form->at(double{time}))) : question(light);
}

Affine3d placeOf(const LightMotion& motion, float time) {
    return motion.place ? motion.place->at(double{time}) : Affine3d();
}

}  // namespace

LightSample LightSet::sampleMoving(int light, Vec3d from, double u0, double u1, float time) const {
    if (light == mesh_) return mesh()->sample(from, u0, u1, time);
    const LightMotion& motion = motions_[static_cast<std::size_t>(light)];
    const Affine3d there = placeOf(motion, time);
    const Vec3d rest = there.inverse().point(from);
    LightSample s = askAtRest((*this)[light], motion, time,
                              [&](const Light& l) { return l.sample(rest, u0, u1); });
    s.direction = there.vector(s.direction);
    return s;
}

double LightSet::pdfMoving(int light, Vec3d from, Vec3d direction, float time) const {
    const LightMotion& motion = motions_[static_cast<std::size_t>(light)];
    take(placeOf(motion, time).inverse(), from, direction);
    return askAtRest((*this)[light], motion, time,
                     [&](const Light& l) { return l.pdf(from, direction); });
}

LightHit LightSet::meetMoving(int light, Vec3d origin, Vec3d direction, float time) const {
    const LightMotion& motion = motions_[static_cast<std::size_t>(light)];
    take(placeOf(motion, time).inverse(), origin, direction);
    return askAtRest((*this)[light], motion, time,
                     [&](const Light& l) { return l.meet(origin, direction); });
}

void LightSet::narrowMoving(int light, Vec3d origin, Vec3d direction, float time, double& t0,
                            double& t1) const {
    const LightMotion& motion = motions_[static_cast<std::size_t>(light)];
    take(placeOf(motion, time).inverse(), origin, direction);
    askAtRest((*this)[light], motion, time,
              [&](const Light& l) { l.narrow(origin, direction, t0, t1); });
}

Vec3d LightSet::positionMoving(int light, Vec3d atRest, float time) const {
    return placeOf(motions_[static_cast<std::size_t>(light)], time).point(atRest);
}

double LightSet::importance(int light, const ScatterPoint& at) const {
    if (!moves(light)) return (*this)[light].importance(at);
    const LightMotion& motion = motions_[static_cast<std::size_t>(light)];
    ScatterPoint rest = at;
    take(placeOf(motion, at.time).inverse(), rest.position, rest.forward);
    return askAtRest((*this)[light], motion, at.time,
                     [&](const Light& l) { return l.importance(rest); });
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
