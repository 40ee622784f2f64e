// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/refined_walk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "woodcock/grid/moved_ranges.h"

namespace woodcock::medium {

namespace {

/// Majorant optical depths below which a piece, or a whole cell, needs no better bounds.
constexpr double shallow = 1, shallowCell = 16;
/// The same of a cell of what moves: its bounds take the time of so many collisions.
constexpr double shallowMovedCell = 512;
/// Bounds whose ratio is at most this are tight: at least every second collision is real.
constexpr float closeRatio = 2;
/// The bounds below are exact but for rounding: of floats, and of index positions.
constexpr double slack = 1e-6, positionSlack = 4e-16;

/// The corners of one cell of the voxel lattice.
struct Lattice {
    Vec3i corner;
    double values[2][2][2];

    Lattice(const grid::Field& field, Vec3i v, int channel) : corner(v) {
        for (int i : {0, 1})
            for (int j : {0, 1})
                for (int k : {0, 1}) values[i][j][k] = field.voxel(v + Vec3i{i, j, k}, channel);
    }
    double at(double x, double y, double z) const {
        const double u[3] = {x - corner.x, y - corner.y, z - corner.z};
        double sum = 0;
        for (int i : {0, 1})
            for (int j : {0, 1})
                for (int k : {0, 1})
                    sum += (i ? u[0] : 1 - u[0]) * (j ? u[1] : 1 - u[1]) * (k ? u[2] : 1 - u[2]) *
                           values[i][j][k];
        return sum;
    }
    /// Bounds of the reconstruction from a to b: along a line it is a cubic, whose Bezier points
    /// are means of its polar form, and that is the trilinear function with mixed arguments.
    /// Ramshaw 1989, "Blossoms are polar forms".
    grid::Range between(Vec3d a, Vec3d b) const {
        const double points[4] = {
            at(a.x, a.y, a.z), (at(b.x, a.y, a.z) + at(a.x, b.y, a.z) + at(a.x, a.y, b.z)) / 3,
            (at(b.x, b.y, a.z) + at(b.x, a.y, b.z) + at(a.x, b.y, b.z)) / 3, at(b.x, b.y, b.z)};
        const auto [low, high] = std::minmax_element(std::begin(points), std::end(points));
        const double largest = *std::max_element(&values[0][0][0], &values[0][0][0] + 8);
        const double place = std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
        const double error = largest * positionSlack * (16 + place);
        return {static_cast<float>(std::max(0.0, *low * (1 - slack) - error)),
                static_cast<float>(std::max(0.0, *high * (1 + slack) + error))};
    }
};

/// Bounds of the values along a ray from a to b, both in the unit cube that begins at voxel `v`;
/// for nearest lookups, in the unit cube around `v`.
grid::Range between(const grid::Field& field, Vec3i v, Vec3d a, Vec3d b, int channel) {
    if (field.lookup() == grid::Lookup::Trilinear) return Lattice(field, v, channel).between(a, b);
    const float value = field.voxel(v, channel);
    return {value, value};
}

/// The same where the field moves: of the box around the way from a to b.
grid::Range movedBetween(const grid::MovedRanges& moved, Vec3d a, Vec3d b, float time,
                         int channel) {
    const grid::Range r = moved.close({min(a, b), max(a, b)}, time, channel);
    return {static_cast<float>(std::max(0.0, double{r.min} * (1 - slack))),
            static_cast<float>(double{r.max} * (1 + slack))};
}

/// base + more, not rounded below it.
float above(float base, double more) { return static_cast<float>((base + more) * (1 + slack)); }

}  // namespace

float RefinedWalk::liveExtinction(const MediumPart& part) const {
    float largest = 0;
    for (int c = 0; c < 3; ++c)
        if (live_ >> c & 1) largest = std::max(largest, part.extinction()[c]);
    return largest;
}

void RefinedWalk::cut(const MediumPart& part, const grid::IndexRay& ray, double t,
                      grid::Segment& segment) {
    if (!tight_) cell_ = segment;
    segment = piece(part, ray, t);
}

/// From `t` to at most the end of the cell being cut and of the voxel cell that holds it.
grid::Segment RefinedWalk::piece(const MediumPart& part, const grid::IndexRay& ray, double t) {
    const double largest = extinction_;
    collisions_ = 0;
    stale_ = false;
    tight_ = (double{cell_.range.max} - cell_.range.min) * largest * (cell_.t1 - t) >
             (part.moved() ? shallowMovedCell : shallowCell);
    if (!tight_) return {t, cell_.t1, cell_.range};
    const grid::Field& field = *part.field();
    const grid::MovedRanges* moved = part.moved();
    const double shift = field.lookup() == grid::Lookup::Nearest ? 0.5 : 0;  // cubes around voxels
    const Vec3d from = ray.at(t);
    Vec3i v = moved ? Vec3i{} : floorToInt(from + Vec3d{shift, shift, shift});
    double end = cell_.t1;
    for (int i = 0; i < 3 && !moved; ++i) {
        const double d = ray.direction[i];
        if (d == 0) continue;
        const auto faceAhead = [&] { return (v[i] - shift + (d > 0 ? 1 : 0) - ray.origin[i]) / d; };
        if (faceAhead() <= t) v[i] += d > 0 ? 1 : -1;  // `from` lies on a face, up to rounding
        end = std::min(end, faceAhead());
    }
    const bool grey = field.channels() == 1;
    grid::Range range;
    while (true) {
        range = {std::numeric_limits<float>::infinity(), 0};
        std::array<grid::Range, 3> channel;
        float largestMin = 0;
        for (int c = 0; c < field.channels(); ++c) {
            if (!grey && !(live_ >> c & 1)) continue;
            grid::Range& r = channel[static_cast<std::size_t>(c)];
            r = moved ? movedBetween(*moved, from, ray.at(end), time_, c)
                      : between(field, v, from, ray.at(end), c);
            const double share = grey ? 1 : part.extinction()[c] / largest;
            largestMin = std::max(largestMin, static_cast<float>(r.min * share));
            range.min = std::min(range.min, r.min);
        }
        range.max = range.min;
        for (int c = 0; c < field.channels(); ++c) {
            // A channel of small extinction may have large values. What counts is their product,
            // above the lower bound that all channels share.
            const grid::Range& r = channel[static_cast<std::size_t>(c)];
            const double share = grey ? 1 : part.extinction()[c] / largest;
            range.max = std::max(range.max, above(range.min, (double{r.max} - range.min) * share));
        }
        if (range.max <= closeRatio * largestMin) break;
        if (double{range.max} * largest * (end - t) <= shallow) break;
        const double middle = t + (end - t) / 2;
        if (!(middle > t && middle < end)) break;
        end = middle;
    }
    return {t, end, range};
}

}  // namespace woodcock::medium
