// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <string>
#include <variant>

#include "woodcock/light/disk_light.h"
#include "woodcock/light/environment.h"
#include "woodcock/light/light_sample.h"
#include "woodcock/light/mesh_light.h"
#include "woodcock/light/point_light.h"
#include "woodcock/light/rectangle_light.h"
#include "woodcock/light/sphere_light.h"
#include "woodcock/light/spot_light.h"
#include "woodcock/light/sun.h"

namespace woodcock::light {

/// What every kind of light answers. Points and directions are in world space.
template <class L>
concept LightKind = requires(const L& l, const ScatterPoint& at, Vec3d v, const Box3d& bounds) {
    { l.traits() } -> std::same_as<LightTraits>;
    /// At a point, by u in [0, 1)^2; of weight 0 where no light is found.
    { l.sample(v, 0.0, 0.0) } -> std::same_as<LightSample>;
    /// Density, per steradian, with which sample() at a point draws a direction; 0 of delta lights.
    { l.pdf(v, v) } -> std::convertible_to<double>;
    /// Importance: what the light could add to the radiance that leaves `at`, unoccluded, averaged
    /// over channels. 0 only where sample() finds nothing.
    { l.importance(at) } -> std::convertible_to<double>;
    /// Roughly the radiance, largest channel, that it makes in a scattering medium of such bounds.
    { l.typicalRadiance(bounds) } -> std::convertible_to<double>;
};
/// A kind that rays can meet on their way: where a ray first does, outside of the light.
template <class L>
concept MeetsRays = requires(const L& l, Vec3d v) {
    { l.meet(v, v) } -> std::same_as<LightHit>;
};
/// A kind that may be infinitely far away: the radiance that arrives from a direction. Such a kind
/// says in its traits whether it is `distant`.
template <class L>
concept Distant = requires(const L& l, Vec3d v) {
    { l.distantRadiance(v) } -> std::same_as<Rgb>;
};
/// A local kind that does not shine everywhere: narrows [t0, t1] to where it can shine on a ray.
template <class L>
concept Narrow = requires(const L& l, Vec3d v, double& t) {
    l.narrow(v, v, t, t);
};
/// A kind of which floats may not hold a number: says so in a sentence, or nothing.
template <class L>
concept MayHaveAFlaw = requires(const L& l) {
    { l.flaw() } -> std::same_as<std::string>;
};

/// A kind that may change within the shutter: what may, and the light of another form.
template <class L>
concept Changes = requires(const L& l, const LightForm& form) {
    { l.form() } -> std::same_as<LightForm>;
    { l.withForm(form) } -> std::same_as<L>;
};

/// A light of any kind. Nothing outside of this room asks which kind it is.
class Light : public std::variant<Sun, Environment, PointLight, SpotLight, SphereLight,
                                  RectangleLight, DiskLight, MeshLight> {
public:
    using variant::variant;

    LightTraits traits() const;
    LightSample sample(Vec3d from, double u0, double u1) const;
    double pdf(Vec3d from, Vec3d direction) const;
    double importance(const ScatterPoint& at) const;
    double typicalRadiance(const Box3d& bounds) const;
    bool meetsRays() const;
    LightHit meet(Vec3d origin, Vec3d direction) const;  ///< a miss where it does not meet rays
    Rgb distantRadiance(Vec3d direction) const;          ///< 0 where it is not distant
    void narrow(Vec3d origin, Vec3d direction, double& t0, double& t1) const;
    std::string flaw() const;
    LightForm form() const;  ///< zeros where it does not change
    Light withForm(const LightForm& form) const;
};

}  // namespace woodcock::light
