// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "woodcock/base/error.h"

namespace woodcock::grid {

namespace {

constexpr double farthest = 1 << 30;  // voxels
/// Relative, of displacements: far above the rounding of the velocities that make them.
constexpr double margin = 1e-6;

double largest(Vec3d v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }
double largest(const Box3d& b) { return std::max(largest(b.lower), largest(b.upper)); }

/// The interval of a product of numbers from two intervals.
std::pair<double, double> product(double a0, double a1, double b0, double b1) {
    const auto [low, high] = std::minmax({a0 * b0, a0 * b1, a1 * b0, a1 * b1});
    return {low, high};
}

/// The voxels that interpolation in `box` reads, of those that differ from the background and one
/// beyond.
Box3i tapsOf(const Field& field, const Box3d& box, double slack) {
    const Box3d& support = field.support();
    if (support.empty()) return {{0, 0, 0}, {0, 0, 0}};
    const Vec3d more{slack, slack, slack}, one{1, 1, 1};
    const auto inside = [&](Vec3d p) {
        return max(support.lower - one, min(support.upper + one, p));
    };
    const Vec3d lower = inside(box.lower - more), upper = inside(box.upper + more);
    return {floorToInt(lower), -floorToInt(-upper)};
}

/// Channels from `first` on at a position of the lattice. As Field::trilinear(), but finds a block
/// once for all voxels in it.
template <int count>
std::array<double, count> valuesAt(const Field& field, int first, Vec3d p) {
    p = field.nearSupport(p);
    const Vec3i v = floorToInt(p);
    const Vec3d f = p - v.as<double>();
    std::array<std::array<double, count>, 8> corners;
    const Vec3i block{v.x >> 3, v.y >> 3, v.z >> 3};
    const Field::BlockVoxels own(field, block);
    const bool whole = (v.x & 7) != 7 && (v.y & 7) != 7 && (v.z & 7) != 7;
    for (int i = 0; i < 8; ++i) {
        const Vec3i at = v + Vec3i{i & 1, i >> 1 & 1, i >> 2};
        const Vec3i its{at.x >> 3, at.y >> 3, at.z >> 3};
        const Field::BlockVoxels voxels =
            whole || its == block ? own : Field::BlockVoxels(field, its);
        for (int c = 0; c < count; ++c)
            corners[static_cast<std::size_t>(i)][static_cast<std::size_t>(c)] =
                voxels(at, first + c);
    }
    const auto lerp = [](double t, double a, double b) { return a + t * (b - a); };
    std::array<double, count> values;
    for (std::size_t c = 0; c < count; ++c) {
        const auto row = [&](std::size_t i) { return lerp(f.x, corners[i][c], corners[i + 1][c]); };
        values[c] =
            static_cast<float>(lerp(f.z, lerp(f.y, row(0), row(2)), lerp(f.y, row(4), row(6))));
    }
    return values;
}

}  // namespace

Motion::Motion(std::shared_ptr<const Velocity> velocity, const Affine3d& objectFromIndex,
               double open, double close)
    : velocity_(std::move(velocity)),
      indexFromObject_(objectFromIndex.inverse()),
      open_(open),
      length_(close - open) {
    for (int i = 0; i < 3; ++i) {
        const Velocity::Source& s = velocity_->source(i);
        // Voxels that lie on those of the moving grid do so exactly.
        const bool same = s.objectFromIndex == objectFromIndex;
        const Affine3d place = same ? Affine3d{} : s.objectFromIndex.inverse() * objectFromIndex;
        Lattice& l = lattices_[static_cast<std::size_t>(i)];
        l = {s.field.get(), s.channel, Affine3d::translate(-s.offset) * place, same ? 0 : 1e-7};
    }
    together_ = true;
    for (int i = 0; i < 3; ++i) {
        const Lattice& l = lattices_[static_cast<std::size_t>(i)];
        together_ &= l.field == lattices_[0].field && l.channel == i &&
                     l.fromIndex == lattices_[0].fromIndex;
    }
    Box3d all;
    for (int i = 0; i < 3; ++i) {
        const Range r = velocity_->source(i).field->range();
        all.lower[i] = r.min, all.upper[i] = r.max;
    }
    const double most = largest(displacements(all, open, close));
    if (!(most <= farthest))
        throw inputError(
            "velocities move a grid by up to {:.3g} voxels while the shutter is open; expected at "
            "most {:.3g}; a smaller velocity_scale or a shorter shutter is needed",
            most, farthest);
}

Vec3d Motion::velocityAt(Vec3d index) const {
    if (together_) {
        const auto v = valuesAt<3>(*lattices_[0].field, 0, lattices_[0].fromIndex.point(index));
        return indexFromObject_.vector({v[0], v[1], v[2]});
    }
    Vec3d v;
    for (int i = 0; i < 3; ++i) {
        const Lattice& l = lattices_[static_cast<std::size_t>(i)];
        v[i] = valuesAt<1>(*l.field, l.channel, l.fromIndex.point(index))[0];
    }
    return indexFromObject_.vector(v);
}

double Motion::mostVoxels() const {
    return length(indexFromObject_.vector(velocity_->fastest().velocity)) *
           std::max(std::abs(open_), std::abs(open_ + length_));
}

Box3d Motion::displacements(const Box3d& velocities, double from, double to) const {
    Box3d moved;
    for (int i = 0; i < 3; ++i) {
        double low = 0, high = 0;
        for (int k = 0; k < 3; ++k) {
            const double a = indexFromObject_.column[static_cast<std::size_t>(k)][i];
            const auto [l, h] = product(a, a, velocities.lower[k], velocities.upper[k]);
            low += l, high += h;
        }
        const auto [l, h] = product(low, high, from, to);
        const double more = std::max(std::abs(l), std::abs(h)) * margin;
        moved.lower[i] = l - more, moved.upper[i] = h + more;
    }
    return moved;
}

template <class RangeOf>
Box3d Motion::sourcesBy(const Box3d& box, double from, double to, RangeOf rangeOf) const {
    const auto moved = [&](const Box3d& places) {
        Box3d velocities;
        for (int i = 0; i < 3; ++i) {
            const Lattice& l = lattices_[static_cast<std::size_t>(i)];
            const Box3d there = l.fromIndex.box(places);
            const Range r = rangeOf(i, there, l.slack * (1 + 1e-7 * largest(there)));
            velocities.lower[i] = r.min, velocities.upper[i] = r.max;
        }
        const Box3d d = displacements(velocities, from, to);
        return Box3d{box.lower - d.upper, box.upper - d.lower};
    };
    const Box3d first = moved(box);
    if (first == box) return box;  // nothing moves
    return moved(first);
}

Box3d Motion::sources(const Box3d& box, double from, double to) const {
    return sourcesBy(box, from, to, [&](int i, const Box3d& there, double slack) {
        const Field& field = *lattices_[static_cast<std::size_t>(i)].field;
        return velocity_->ranges(i).range(tapsOf(field, there, slack));
    });
}

Box3d Motion::closeSources(const Box3d& box, float time) const {
    const double dt = open_ + double{time} * length_;
    return sourcesBy(box, dt, dt, [&](int i, const Box3d& there, double slack) {
        const Lattice& l = lattices_[static_cast<std::size_t>(i)];
        const Vec3d more{slack, slack, slack};
        const Box3d wider{there.lower - more, there.upper + more};
        constexpr double few = 3;
        if (largest(wider.size()) > few)
            return velocity_->ranges(i).range(tapsOf(*l.field, there, slack));
        return interpolatedRange(*l.field, l.channel, wider);
    });
}

Box3d Motion::reached(const Box3d& box) const {
    // Where the velocity is that around all voxels, it is the same at both look-ups, unless the
    // first leads to voxels that have another.
    const Vec3d v = velocity_->background();
    const Box3d d = displacements({v, v}, open_, open_ + length_);
    Box3d all = box;
    if (const Box3d voxels = velocity_->support(); !voxels.empty())
        all.add(indexFromObject_.box(voxels));
    if (all.empty()) return all;
    all.add(Box3d{all.lower + d.lower, all.upper + d.upper});
    return all;
}

Range interpolatedRange(const Field& field, int channel, const Box3d& box) {
    if (field.lookup() == Lookup::Nearest || field.support().empty()) {
        Range r{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
        const Box3i taps = tapsOf(field, box, 0);
        for (int x = taps.lower.x; x <= taps.upper.x; ++x)
            for (int y = taps.lower.y; y <= taps.upper.y; ++y)
                for (int z = taps.lower.z; z <= taps.upper.z; ++z) {
                    const float v = field.voxel({x, y, z}, channel);
                    r.add({v, v});
                }
        return r;
    }
    const Vec3d lower = field.nearSupport(box.lower), upper = field.nearSupport(box.upper);
    std::array<std::vector<double>, 3> planes;  // the box's faces, and voxels between them
    for (int i = 0; i < 3; ++i) {
        auto& p = planes[static_cast<std::size_t>(i)];
        p.push_back(lower[i]);
        for (double x = std::floor(lower[i]) + 1; x < upper[i]; ++x) p.push_back(x);
        if (upper[i] > lower[i]) p.push_back(upper[i]);
    }
    Range r{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
    for (double x : planes[0])
        for (double y : planes[1])
            for (double z : planes[2]) {
                const float v = field.trilinear({x, y, z}, channel);
                r.add({v, v});
            }
    return r;
}

}  // namespace woodcock::grid
