// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/optical_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "woodcock/medium/density_pieces.h"
#include "woodcock/medium/tracking.h"

namespace woodcock::medium {

Rgb exactOpticalDepth(const Medium& medium, Vec3d origin, Vec3d direction, double t0, double t1,
                      float time) {
    Vec3d depth;
    for (const MediumPart& part : medium.parts) {
        const grid::IndexRay ray = part.indexRay(origin + direction * t0, direction, time);
        walkDensity(part, ray, t1 - t0, time, [&](const auto& piece, double a, double b) {
            const std::array<double, 3> f = integrals<3>(piece, a, b);
            for (int c = 0; c < 3; ++c)
                if (part.extinction()[c] > 0)
                    depth[c] += f[static_cast<std::size_t>(c)] * double{part.extinction()[c]};
            return true;
        });
    }
    return {static_cast<float>(depth.x), static_cast<float>(depth.y), static_cast<float>(depth.z)};
}

template <int N>
Spectrum<N> exactTransmittance(const Medium& medium, Vec3d origin, Vec3d direction,
                               TrackingCounters& counters) {
    constexpr double vanished = 104;  // exp() of minus this is zero as a float
    constexpr double endless = std::numeric_limits<double>::infinity();
    std::array<double, N> depth{};
    for (const MediumPart& part : medium.parts) {
        const auto add = [&](const auto& piece, double a, double b) {
            ++counters.segments;
            const std::array<double, N> f = integrals<N>(piece, a, b);
            double least = std::numeric_limits<double>::infinity();
            for (int c = 0; c < N; ++c) {
                double& d = depth[static_cast<std::size_t>(c)];
                if (part.extinction()[c] > 0)
                    d += f[static_cast<std::size_t>(c)] * double{part.extinction()[c]};
                least = std::min(least, d);
            }
            return least < vanished;
        };
        if (!walkDensity(part, part.indexRay(origin, direction), endless, 0, add)) return {};
    }
    return Spectrum<N>::map(
        [&](int c) { return static_cast<float>(std::exp(-depth[static_cast<std::size_t>(c)])); });
}

template Spectrum<1> exactTransmittance(const Medium&, Vec3d, Vec3d, TrackingCounters&);
template Spectrum<3> exactTransmittance(const Medium&, Vec3d, Vec3d, TrackingCounters&);

namespace {

double transmittanceAt(Vec3d depth) {
    return (std::exp(-depth.x) + std::exp(-depth.y) + std::exp(-depth.z)) / 3;
}

/// The point of the same ray at `t`, further on.
DepthAlong movedTo(const DepthAlong& along, double t) {
    const Rgb more =
        exactOpticalDepth(along.medium, along.origin, along.direction, along.t, t, along.time);
    return {along.medium,
            along.origin,
            along.direction,
            along.time,
            t,
            along.depth + Vec3d{more[0], more[1], more[2]}};
}

void moveTo(DepthAlong& along, const DepthAlong& further) {
    along.t = further.t, along.depth = further.depth;
}

/// From where to where a ray may meet anything; to infinity in a medium without bounds.
std::pair<double, double> reachOf(const DepthAlong& along, double tMax) {
    double begin = tMax, end = along.t;
    for (const MediumPart& part : along.medium.parts) {
        double t0 = along.t, t1 = tMax;
        if (!part.unbounded() &&
            !grid::clip({along.origin, along.direction}, part.worldBounds(), t0, t1))
            continue;
        begin = std::min(begin, t0), end = std::max(end, t1);
    }
    return {begin, end};
}

/// Between a point before the sought one and `end` behind it, at which `missing` is what lacks to
/// the sought logarithm of the transmittance; it is negative there. By false position, with the
/// Illinois algorithm's halving of an end that stays (Dowell and Jarratt 1971).
void close(DepthAlong& along, double end, double missingAtEnd,
           const std::function<double(Vec3d)>& missing) {
    constexpr double precision = 1e-7, least = 0.02;
    double before = missing(along.depth), behind = missingAtEnd;
    bool wasBefore = false, wasBehind = false;
    while (end - along.t > precision * end) {
        const double share = std::clamp(before / (before - behind), least, 1 - least);
        const DepthAlong there = movedTo(along, along.t + share * (end - along.t));
        const double left = missing(there.depth);
        if (left > 0 || left > -precision) moveTo(along, there);
        if (std::abs(left) < precision) return;
        if (left > 0) {
            if (wasBefore) behind /= 2;
            before = left;
        } else {
            if (wasBehind) before /= 2;
            behind = left, end = there.t;
        }
        wasBefore = left > 0, wasBehind = !wasBefore;
    }
}

}  // namespace

bool findTransmittance(DepthAlong& along, double tMax, double transmittance) {
    constexpr double farthest = 1e30, firstPiece = 1.0 / 32;
    const auto missing = [&](Vec3d depth) {
        return std::log(transmittanceAt(depth) / transmittance);
    };
    if (missing(along.depth) <= 0) return true;
    const auto [begin, end] = reachOf(along, tMax);
    if (!(end > begin)) return false;
    along.t = begin;
    // Pieces that grow: most rays that lose so much do so soon, and a medium may have no end.
    double step = std::isfinite(end) ? (end - begin) * firstPiece : 1;
    for (; along.t < end && along.t < farthest; step *= 2) {
        const DepthAlong there = movedTo(along, std::min(along.t + step, end));
        if (const double left = missing(there.depth); left <= 0) {
            close(along, there.t, left, missing);
            return true;
        }
        moveTo(along, there);
    }
    return false;
}

}  // namespace woodcock::medium
