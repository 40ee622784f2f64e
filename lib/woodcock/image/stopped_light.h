// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "woodcock/base/spectrum.h"

namespace woodcock::image {

/// Where one camera ray's light ends on its way, and from where it brings light: for mattes and
/// deep pixels. Depths are planar: along the camera's axis, in world units, never negative.
struct StoppedLight {
    /// A piece of the ray, or a point where near = far, at which something stops light.
    struct Stop {
        double near, far;
        /// What all that is there leaves of the light, from 1 at the camera. Within the piece it
        /// falls exponentially. Of single rays in coloured media, it may grow.
        double before, after;
        double share = 1;     ///< of that which this owner stops
        std::uint32_t owner;  ///< see render::Scene::partOwners
        enum class Kind : std::uint8_t { Medium, Surface, ShadowCatcher } kind = Kind::Medium;

        double amount() const { return share * (before - after); }
        /// The part of it that is stopped before a depth.
        double amountBefore(double depth) const;
    };
    /// Radiance that comes from a depth.
    struct Arrival {
        double depth;
        Rgb radiance;
        bool fromPoint;              ///< from a surface or a lamp, not from media
        std::uint32_t owner = lamp;  ///< of a surface
    };
    static constexpr std::uint32_t lamp = 0xffffffffu;

    /// In order. Their amounts add up to the ray's alpha; those of shadow catchers come on top.
    std::vector<Stop> stops;
    /// They add up to the ray's radiance without the background.
    std::vector<Arrival> arrivals;
    /// The path's first scattering, or the surface that it meets; its radiance is added last.
    std::optional<Arrival> firstEvent = {};
};

}  // namespace woodcock::image
