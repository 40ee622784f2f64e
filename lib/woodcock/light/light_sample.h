// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "woodcock/base/spectrum.h"
#include "woodcock/base/vec.h"
#include "woodcock/medium/phase.h"

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

/// Where a ray meets a light, and the radiance that it brings back along the ray.
struct LightHit {
    double distance = std::numeric_limits<double>::infinity();  ///< infinity: it misses
    Rgb radiance;
};

/// What may change of a light within the shutter beside its place, as numbers between which it goes
/// straight: sizes, brightness. Each kind has its own; what is left over is 0.
using LightForm = std::array<double, 6>;
inline Rgb colourOf(const LightForm& form, std::size_t first) {
    return Rgb::map(
        [&](int c) { return static_cast<float>(form[first + static_cast<size_t>(c)]); });
}

/// A point that scatters light, as light selection needs it.
struct ScatterPoint {
    Vec3d position;
    Vec3d forward;  ///< unit: the way the path came along
    const medium::PhaseFunction* phase = &medium::isotropicScattering;
    float time = 0;  ///< of the path, within the shutter

    /// The phase function's density, per steradian, towards a unit vector.
    double phaseTowards(Vec3d towards) const { return phase->value(dot(forward, towards)); }
};

/// What the path tracer has to know of a light before it asks for samples.
struct LightTraits {
    /// "a point light": for messages.
    const char* name = "a light";
    /// World position of a local light; equiangular sampling aims at it. Absent: the light is
    /// infinitely far away, or is the scene's surfaces.
    std::optional<Vec3d> position = {};
    /// Next-event estimation samples it. False: the phase function samples it perfectly by itself.
    bool sampled = true;
    /// Rays that escape meet its radiance: an environment, the disc of a sun.
    bool distant = false;
    bool visible = false;  ///< to camera rays, where rays can meet it
    /// Towards a light whose rays are parallel, or nearly so: a sun of at most 2 degrees, or one of
    /// an environment's image.
    std::optional<Vec3d> parallel = {};
    /// Of a local light: the most power per solid angle, largest channel.
    double intensity = 0;
};

/// Roughly the radiance that a local light makes in a scattering medium of such bounds: by the
/// irradiance at its centre, from at least a quarter of its diagonal away.
inline double radianceOfLocalLight(Vec3d position, double intensity, const Box3d& bounds) {
    const double size = length(bounds.size()) / 4;
    const double d = std::max(size, length(bounds.centre() - position));
    return d > 0 ? intensity / (d * d) / (4 * pi) : 0;
}

}  // namespace woodcock::light
