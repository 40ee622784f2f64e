// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/light.h"

namespace woodcock::light {

namespace {

template <class F>
decltype(auto) ask(const Light& light, F&& question) {
    return std::visit(
        [&]<LightKind Kind>(const Kind& kind) -> decltype(auto) { return question(kind); }, light);
}

}  // namespace

LightTraits Light::traits() const {
    return ask(*this, [](const auto& l) { return l.traits(); });
}

LightSample Light::sample(Vec3d from, double u0, double u1) const {
    return ask(*this, [&](const auto& l) { return l.sample(from, u0, u1); });
}

double Light::pdf(Vec3d from, Vec3d direction) const {
    return ask(*this, [&](const auto& l) { return double{l.pdf(from, direction)}; });
}

double Light::importance(const ScatterPoint& at) const {
    return ask(*this, [&](const auto& l) { return double{l.importance(at)}; });
}

double Light::typicalRadiance(const Box3d& bounds) const {
    return ask(*this, [&](const auto& l) { return double{l.typicalRadiance(bounds)}; });
}

bool Light::meetsRays() const {
    return ask(*this, [](const auto& l) { return MeetsRays<std::remove_cvref_t<decltype(l)>>; });
}

LightHit Light::meet(Vec3d origin, Vec3d direction) const {
    return ask(*this, [&](const auto& l) {
        if constexpr (MeetsRays<std::remove_cvref_t<decltype(l)>>)
            return l.meet(origin, direction);
        else
            return LightHit();
    });
}

Rgb Light::distantRadiance(Vec3d direction) const {
    return ask(*this, [&](const auto& l) {
        if constexpr (Distant<std::remove_cvref_t<decltype(l)>>)
            return l.distantRadiance(direction);
        else
            return Rgb();
    });
}

void Light::narrow(Vec3d origin, Vec3d direction, double& t0, double& t1) const {
    ask(*this, [&](const auto& l) {
        if constexpr (Narrow<std::remove_cvref_t<decltype(l)>>) l.narrow(origin, direction, t0, t1);
    });
}

std::string Light::flaw() const {
    return ask(*this, [](const auto& l) {
        if constexpr (MayHaveAFlaw<std::remove_cvref_t<decltype(l)>>)
            return l.flaw();
        else
            return std::string();
    });
}

LightForm Light::form() const {
    return ask(*this, [](const auto& l) {
        if constexpr (Changes<std::remove_cvref_t<decltype(l)>>)
            return l.form();
        else
            return LightForm();
    });
}

Light Light::withForm(const LightForm& form) const {
    return ask(*this, [&](const auto& l) -> Light {
        if constexpr (Changes<std::remove_cvref_t<decltype(l)>>)
            return l.withForm(form);
        else
            return l;
    });
}

}  // namespace woodcock::light
