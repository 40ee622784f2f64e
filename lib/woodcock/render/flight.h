// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "woodcock/light/light_set.h"
#include "woodcock/medium/medium.h"
#include "woodcock/render/equiangular.h"

namespace woodcock::render {

/// What sampling along a ray knows of a medium beforehand.
struct MediumSummary {
    const medium::Medium* medium;  ///< that rays go through
    std::span<const medium::EmissionPart> emission;
    Box3d bounds;
    double meanExtinction = 0;
    bool unbounded = false, scatters = false;

    explicit MediumSummary(const medium::Medium& m) : MediumSummary(m, m) {}
    /// `m` is used in place of `original`, and has the emission of `original`.
    MediumSummary(const medium::Medium& m, const medium::Medium& original)
        : medium(&m), emission(original.emission), bounds(m.worldBounds()) {
        for (const medium::MediumPart& p : m.parts) {
            meanExtinction += p.meanExtinction();
            unbounded |= p.unbounded();
            scatters |= p.scatters();
        }
    }
};

/// A straight piece of a path through one medium.
struct Flight {
    Vec3d origin, direction;
    double tMax = std::numeric_limits<double>::infinity();
    float time = 0;
    const MediumSummary* medium = nullptr;

    /// Distances at which a local light may shine on the medium.
    Equiangular equiangular(const light::LightSet& lights, int light, Vec3d lightPosition) const {
        double t0 = 0, t1 = tMax;
        if (!medium->unbounded && !grid::clip({origin, direction}, medium->bounds, t0, t1))
            return {};
        const double entry = t0;
        lights.narrow(light, origin, direction, time, t0, t1);
        return {origin, direction, lightPosition, t0, t1, length(medium->bounds.size()) * 1e-9,
                entry};
    }
    /// The density, per world unit, with which tracking would find its event at `t` if the medium
    /// were homogeneous.
    double density(const Equiangular& e, double t) const {
        const double sigma = medium->meanExtinction;
        return sigma * std::exp(-sigma * std::max(0.0, t - e.entry()));
    }
};

/// Splits a local light's direct light between the event that distance sampling found on a flight
/// and the point that equiangular sampling chose on it. Null-collision tracking does not know the
/// density of its event, so the balance heuristic takes that of a homogeneous medium. Both sides
/// use the same formula, so the sum is unbiased however rough that density is.
struct FlightShare {
    bool all = true;  ///< the event's alone: nothing was chosen on its flight
    Flight flight = {};
    double t = 0;
    /// The event's part of the light from a light.
    double operator()(const light::LightSet& lights, int light) const {
        if (all) return 1;
        const std::optional<Vec3d> position = lights.position(light, flight.time);
        if (!position) return 1;  // it is not local
        const Equiangular e = flight.equiangular(lights, light, *position);
        const double other = e.pdf(t);
        const double own = flight.density(e, t);
        return own + other > 0 ? own / (own + other) : 1;
    }
};

}  // namespace woodcock::render
