// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "woodcock/medium/medium.h"
#include "woodcock/render/equiangular.h"

namespace woodcock {

/// What sampling along a ray may know of a medium beforehand.
struct MediumSummary {
    const Medium* medium;  ///< that rays go through
    std::span<const EmissionPart> emission;
    Box3d bounds;
    double meanExtinction = 0;
    bool unbounded = false, scatters = false;

    explicit MediumSummary(const Medium& m) : MediumSummary(m, m) {}
    /// Of a stand-in for `original`, which glows like it.
    MediumSummary(const Medium& m, const Medium& original)
        : medium(&m), emission(original.emission), bounds(m.worldBounds()) {
        for (const MediumPart& p : m.parts) {
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
    const MediumSummary* medium = nullptr;

    Equiangular equiangular(Vec3d lamp) const {
        double t0 = 0, t1 = tMax;
        if (!medium->unbounded && !clip({origin, direction}, medium->bounds, t0, t1)) return {};
        return {origin, direction, lamp, t0, t1, length(medium->bounds.size()) * 1e-9};
    }
    /// A homogeneous stand-in for the density with which tracking finds its event.
    double density(const Equiangular& e, double t) const {
        const double sigma = medium->meanExtinction;
        return sigma * std::exp(-sigma * std::max(0.0, t - e.t0()));
    }
};

/// Splits a local light's direct light between the event that distance sampling found on a flight
/// and the point that equiangular sampling chose on it: the balance heuristic with a homogeneous
/// stand-in for the density of the former, which null-collision tracking does not know. Both sides
/// use the same formula, so the sum is unbiased whatever its quality.
struct FlightShare {
    bool all = true;  ///< the event's alone: nothing was chosen on its flight
    Flight flight = {};
    double t = 0;
    /// The event's part of light from a lamp at `position`.
    double operator()(Vec3d position) const {
        if (all) return 1;
        const Equiangular e = flight.equiangular(position);
        const double other = e.pdf(t);
        const double own = flight.density(e, t);
        return own + other > 0 ? own / (own + other) : 1;
    }
};

}  // namespace woodcock
