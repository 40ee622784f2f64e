// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/light_set.h"

#include <algorithm>

#include "woodcock/medium/phase.h"

namespace woodcock::light {

namespace {

template <class... F>
struct Overloaded : F... {
    using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

/// Importance of a light: what it could add to the radiance that leaves `at`, unoccluded, averaged
/// over channels.
double importance(const Light& light, const ScatterPoint& at) {
    const auto phase = [&](Vec3d towards) {
        return medium::henyeyGreenstein(dot(at.forward, towards), at.g);
    };
    return std::visit(
        Overloaded{[&](const Sun& l) { return l.irradiance().mean() * phase(l.towards()); },
                   [&](const Environment& l) { return double{l.meanRadiance().mean()}; },
                   [&](const PointLight& l) {
                       const LightSample s = l.sample(at.position);
                       return s.weight.mean() * phase(s.direction);
                   },
                   [&](const SphereLight& l) {
                       const Vec3d d = l.position - at.position;
                       const double distance = std::max(length(d), l.radius);
                       const double area = pi * l.radius * l.radius / (distance * distance);
                       // Half by the phase function towards the centre, half as if isotropic: a
                       // wide light also sends light from directions beside its centre.
                       const double p = distance > l.radius ? phase(d / distance) : 0;
                       return l.radiance.mean() * area * (0.5 * p + 0.5 / (4 * pi));
                   },
                   [&](const MeshLight& l) {
                       const Vec3d d = l.centre() - at.position;
                       const double distance = length(d);
                       const double p = distance > 0 ? phase(d / distance) : 0;
                       return l.importance(at.position) * (0.5 * p + 0.5 / (4 * pi));
                   }},
        light);
}

}  // namespace

LightSet::LightSet(std::vector<Light> lights) : lights_(std::move(lights)) {
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        const auto* environment = std::get_if<Environment>(&lights_[i]);
        if (environment && environment->constant()) continue;
        sampled_.push_back(static_cast<int>(i));
        if (std::holds_alternative<PointLight>(lights_[i]) ||
            std::holds_alternative<SphereLight>(lights_[i]))
            local_.push_back(static_cast<int>(i));
        if (std::holds_alternative<MeshLight>(lights_[i])) mesh_ = static_cast<int>(i);
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
        const double p = importance(lights_[static_cast<std::size_t>(sampled_[i])], at);
        probabilities[i] = static_cast<float>(std::min(p, 1e30));
        total += probabilities[i];
    }
    for (float& p : probabilities) p = total > 0 ? static_cast<float>(p / total) : 0;
}

LightSample LightSet::sample(int light, Vec3d from, double u0, double u1) const {
    return std::visit(Overloaded{[&](const Sun& l) { return l.sample(u0, u1); },
                                 [&](const Environment& l) { return l.sample(u0, u1); },
                                 [&](const PointLight& l) { return l.sample(from); },
                                 [&](const SphereLight& l) { return l.sample(from, u0, u1); },
                                 [&](const MeshLight& l) {
                                     std::uint32_t triangle = 0;
                                     return l.sample(from, u0, u1, triangle);
                                 }},
                      lights_[static_cast<std::size_t>(light)]);
}

double LightSet::pdf(int light, Vec3d from, Vec3d direction) const {
    return std::visit(Overloaded{[&](const Sun& l) { return l.pdf(direction); },
                                 [&](const Environment& l) { return l.pdf(direction); },
                                 [&](const PointLight&) { return 0.0; },
                                 [&](const SphereLight& l) { return l.pdf(from, direction); },
                                 [&](const MeshLight&) { return 0.0; }},
                      lights_[static_cast<std::size_t>(light)]);
}

Rgb LightSet::distantRadiance(int light, Vec3d direction, bool cameraRay) const {
    const Light& l = lights_[static_cast<std::size_t>(light)];
    if (const auto* e = std::get_if<Environment>(&l); e && (e->visible() || !cameraRay))
        return e->radiance(direction);
    if (const auto* s = std::get_if<Sun>(&l); s && (s->visible() || !cameraRay))
        return s->radiance(direction);
    return {};
}

bool LightSet::showsBackground() const {
    return std::any_of(lights_.begin(), lights_.end(), [](const Light& l) {
        const auto* environment = std::get_if<Environment>(&l);
        const auto* sun = std::get_if<Sun>(&l);
        return (environment && environment->visible()) || (sun && sun->visible() && !sun->delta());
    });
}

float LightSet::typicalRadiance(const Box3d& bounds) const {
    if (bounds.empty()) return 0;
    const double size = length(bounds.size()) / 4;
    double sum = 0;
    for (const Light& light : lights_) {
        const auto far = [&](Vec3d p,
                             double power) {  // irradiance, from a distance of at least `size`
            const double d = std::max(size, length(bounds.centre() - p));
            return d > 0 ? power / (d * d) / (4 * pi) : 0;
        };
        sum += std::visit(
            Overloaded{[&](const Sun& l) { return l.irradiance().maximum() / (4 * pi); },
                       [&](const Environment& l) { return double{l.meanRadiance().maximum()}; },
                       [&](const PointLight& l) { return far(l.position, l.intensity.maximum()); },
                       [&](const SphereLight& l) {
                           return far(l.position, l.radiance.maximum() * pi * l.radius * l.radius);
                       },
                       [&](const MeshLight& l) { return far(l.centre(), l.power() / (4 * pi)); }},
            light);
    }
    return static_cast<float>(sum);
}

}  // namespace woodcock::light
