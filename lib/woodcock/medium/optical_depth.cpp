// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/optical_depth.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "woodcock/medium/look_up.h"

namespace woodcock::medium {

Rgb exactOpticalDepth(const Medium& medium, Vec3d origin, Vec3d direction, double t0, double t1,
                      float time) {
    Vec3d depth;
    std::vector<double> planes;
    for (const MediumPart& part : medium.parts) {
        const grid::IndexRay ray = part.indexRay(origin + direction * t0, direction);
        PartWalk walk(part, ray, t1 - t0);
        grid::Segment s;
        while (walk.next(s)) {
            const auto add = [&](double length, auto&& valueOf) {
                for (int c = 0; c < 3; ++c) {
                    const double sigma = valueOf(c) * double{part.extinction()[c]};
                    if (sigma > 0) depth[c] += length * sigma;  // lengths may be infinite
                }
            };
            if (s.range.min == s.range.max) {
                add(s.t1 - s.t0, [&](int) { return double{s.range.min}; });
                continue;
            }
            if (!walk.insideSupport(s)) {
                add(s.t1 - s.t0, [&](int c) { return double{part.field()->background(c)}; });
                continue;
            }
            const grid::Field& field = *part.field();
            if (part.moved()) {
                const double length = s.t1 - s.t0;
                const auto points = static_cast<int>(
                    std::ceil(std::max(1.0, 8 * length * woodcock::length(ray.direction))));
                for (int i = 0; i < points; ++i) {
                    const Rgb f = densityAt<3>(part, ray.at(s.t0 + length * (i + 0.5) / points),
                                               time, InFull{});
                    add(length / points, [&](int c) { return double{f[c]}; });
                }
                continue;
            }
            const double shift = field.lookup() == grid::Lookup::Nearest ? 0.5 : 0;
            planes = {s.t0, s.t1};
            for (int i = 0; i < 3; ++i) {
                if (ray.direction[i] == 0) continue;
                const double a = ray.at(s.t0)[i] + shift, b = ray.at(s.t1)[i] + shift;
                for (double x = std::ceil(std::min(a, b)); x <= std::floor(std::max(a, b)); ++x) {
                    const double t = (x - shift - ray.origin[i]) / ray.direction[i];
                    if (t > s.t0 && t < s.t1) planes.push_back(t);
                }
            }
            std::sort(planes.begin(), planes.end());
            for (std::size_t i = 0; i + 1 < planes.size(); ++i) {
                const double middle = (planes[i] + planes[i + 1]) / 2;
                const double half = (planes[i + 1] - planes[i]) / 2;
                for (double node : {-0.57735026918962576, 0.57735026918962576})
                    add(half, [&](int c) {
                        return double{field.trilinear(ray.at(middle + half * node),
                                                      field.channels() == 1 ? 0 : c)};
                    });
            }
        }
    }
    return {static_cast<float>(depth.x), static_cast<float>(depth.y), static_cast<float>(depth.z)};
}

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
