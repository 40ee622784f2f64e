// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <variant>

#include "woodcock/base/affine.h"
#include "woodcock/base/spectrum.h"
#include "woodcock/light/environment_map.h"
#include "woodcock/light/mesh_light.h"

namespace woodcock::light {

/// Light that arrives at a point from one direction, drawn by a light's own sampling.
struct LightSample {
    Vec3d direction;  ///< from the point towards the light, unit length
    double distance = std::numeric_limits<double>::infinity();
    Rgb weight;      ///< radiance / pdf; of a delta light, the irradiance perpendicular to the
                     ///< direction
    double pdf = 0;  ///< per steradian; 0: a delta light, which no other sampling can find
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t emitter = none;  ///< of a MeshLight: the triangle
};

/// Parallel rays, or a disc of uniform radiance in the sky.
class Sun {
public:
    /// `travel`: the direction in which its light goes (world). `irradiance`: on a surface
    /// perpendicular to it.
    Sun(Vec3d travel, Rgb irradiance, double angularDiameterDegrees, bool visible);

    bool delta() const { return sinHalf_ == 0; }
    bool visible() const { return visible_; }
    Rgb irradiance() const { return irradiance_; }
    Vec3d towards() const { return towards_; }

    LightSample sample(double u0, double u1) const;
    double pdf(Vec3d direction) const;    ///< 0 outside the disc and for delta
    Rgb radiance(Vec3d direction) const;  ///< of the disc; 0 for delta

private:
    Vec3d towards_;
    Rgb irradiance_;
    double sinHalf_, oneMinusCos_;  // of half the angular diameter
    bool visible_;
};

/// Radiance from all around: a constant, or a lat-long image times one.
class Environment {
public:
    Environment(Rgb radiance, bool visible) : scale_(radiance), visible_(visible) {}
    Environment(EnvironmentMap map, Rgb scale, const Affine3d& worldFromLight, bool visible);

    bool constant() const { return map_.empty(); }
    bool visible() const { return visible_; }
    const EnvironmentMap& map() const { return map_; }
    Rgb meanRadiance() const;  ///< over the sphere

    Rgb radiance(Vec3d direction) const;
    LightSample sample(double u0, double u1) const;  ///< of the image; constants need none
    double pdf(Vec3d direction) const;

private:
    EnvironmentMap map_;
    Rgb scale_;
    Affine3d worldFromLight_, lightFromWorld_;
    bool visible_;
};

struct PointLight {
    Vec3d position;
    Rgb intensity;  ///< power per solid angle

    LightSample sample(Vec3d from) const;
};

/// A sphere that emits uniform radiance outwards and lets other light pass. It emits nothing
/// inwards.
struct SphereLight {
    Vec3d position;
    double radius;
    Rgb radiance;
    bool visible = true;

    LightSample sample(Vec3d from, double u0, double u1) const;  ///< weight 0 from inside
    double pdf(Vec3d from, Vec3d direction) const;
    /// Distance at which a ray from outside enters the sphere; infinity when the ray misses it.
    double hit(Vec3d origin, Vec3d direction) const;
};

using Light = std::variant<Sun, Environment, PointLight, SphereLight, MeshLight>;

}  // namespace woodcock::light
