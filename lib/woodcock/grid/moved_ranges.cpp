// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/moved_ranges.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_set>

#include "woodcock/base/error.h"

namespace woodcock::grid {

namespace {

using Corner = Vec3<std::int64_t>;

Vec3d uniform(double v) { return {v, v, v}; }

/// The smallest box of whole voxels around `box`.
Box3d wholeVoxels(const Box3d& box) {
    const auto down = [](Vec3d p) {
        return Vec3d{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
    };
    return {down(box.lower), -down(-box.upper)};
}

Box3d cubeAt(Corner corner, int log2Size) {
    const Vec3d lower = corner.as<double>();
    return {lower, lower + uniform(std::ldexp(1.0, log2Size))};
}

bool overlap(const Box3d& a, const Box3d& b) {
    for (int i = 0; i < 3; ++i)
        if (a.lower[i] > b.upper[i] || a.upper[i] < b.lower[i]) return false;
    return true;
}

bool isInside(const Box3d& inner, const Box3d& outer) {
    return outer.contains(inner.lower) && outer.contains(inner.upper);
}

}  // namespace

struct MovedRanges::Cube {
    Corner corner;
    int log2Size;
    Range range{};
    bool outside = false, loose = false;
};

MovedRanges::MovedRanges(std::shared_ptr<const Field> field, std::shared_ptr<const Motion> motion)
    : field_(std::move(field)), motion_(std::move(motion)), tree_(field_) {
    const Range outside =
        field_->limits() ? Range{0, 0} : field_->storedRange(field_->blocks().outside());
    blocks_ = BlockTable<Range>({}, outside, false);
    if (field_->extent().empty()) return;
    reach_ = wholeVoxels(motion_->reached(field_->extent()));
    constexpr double farthest = 2147483000;
    for (int i = 0; i < 3; ++i)
        if (!(reach_.lower[i] > -farthest && reach_.upper[i] < farthest))
            throw inputError(
                "velocities move a grid to index {:.3g}; expected indices below {:.3g}",
                std::max(-reach_.lower[i], reach_.upper[i]), farthest);
    place(differing());
}

Box3i MovedRanges::tapsOf(const Box3d& sources) const {
    // Beyond its extent the field is its background, or 0.
    const auto inside = [&](Vec3d p) {
        const Box3d& box = field_->extent();
        return max(box.lower - uniform(2), min(box.upper + uniform(2), p));
    };
    return {floorToInt(inside(sources.lower)), -floorToInt(-inside(sources.upper))};
}

bool MovedRanges::isOutside(const Box3d& sources, Range range) const {
    const Range outside = blocks_.outside();
    // Where channels differ, a range does not tell.
    return range == outside && (outside.min == outside.max || tree_.isOutside(tapsOf(sources)));
}

Range MovedRanges::rangeFrom(const Box3d& sources) const {
    const auto read = [&](const Box3d& box) { return tree_.range(tapsOf(box)); };
    const auto& limits = field_->limits();
    if (!limits || isInside(sources, *limits)) return read(sources);
    if (!overlap(sources, *limits)) return {0, 0};
    Range range = read({max(sources.lower, limits->lower), min(sources.upper, limits->upper)});
    range.add({0, 0});
    return range;
}

std::array<Range, 64> MovedRanges::finest(Vec3i block) const {
    std::array<Range, 64> cells;
    const Vec3d corner = (block * 8).as<double>();
    constexpr double wide = 4 << blockLog2;  // its parts come from much the same voxels
    if (const Vec3d s = motion_->sources({corner, corner + uniform(8)}).size();
        std::max({s.x, s.y, s.z}) > wide) {
        cells.fill(*blocks_.find(block).value);
        return cells;
    }
    for (int part = 0; part < 8; ++part) {
        const Vec3i p{(part & 1) * 4, (part >> 1 & 1) * 4, (part >> 2) * 4};
        const Vec3d lower = corner + p.as<double>();
        const Box3d box{lower, lower + uniform(4)};
        const Box3d from = motion_->sources(box);
        const Box3d beyond{from.lower - box.lower, from.upper - box.upper};
        for (int i = 0; i < 8; ++i) {
            const Vec3i c = p + Vec3i{(i & 1) * 2, (i >> 1 & 1) * 2, (i >> 2) * 2};
            const Vec3d at = corner + c.as<double>();
            cells[static_cast<std::size_t>(c.x / 2 + c.y / 2 * 4 + c.z / 2 * 16)] =
                rangeFrom({at + beyond.lower, at + uniform(2) + beyond.upper});
        }
    }
    return cells;
}

Range MovedRanges::close(const Box3d& box, float time, int channel) const {
    constexpr double few = 3;
    const Box3d from = motion_->closeSources(box, time);
    const Vec3d size = from.size();
    const auto& limits = field_->limits();
    if (std::max({size.x, size.y, size.z}) > few) return rangeFrom(from);
    if (limits && !overlap(from, *limits)) return {0, 0};
    Range range = interpolatedRange(*field_, channel, from);
    if (limits && !isInside(from, *limits)) range.add({0, 0});
    return range;
}

std::vector<MovedRanges::Cube> MovedRanges::differing() const {
    // A table of blocks takes 32 kB for each region of which it has blocks.
    constexpr std::size_t mostRegions = 1 << 14, mostSupers = 1 << 16;
    const Vec3d size = reach_.size();
    const Corner lower = reach_.lower.as<std::int64_t>();
    const std::int64_t step = std::int64_t{1} << superLog2;
    const Corner origin{lower.x & -step, lower.y & -step, lower.z & -step};
    const auto widest = static_cast<std::uint64_t>(std::max({size.x, size.y, size.z}) + 4096);
    int log2Size = std::max(static_cast<int>(std::bit_width(widest)), superLog2);
    std::vector<Cube> found, level{{origin, log2Size}};
    for (; !level.empty(); --log2Size) {
        tbb::parallel_for(std::size_t{0}, level.size(), [&](std::size_t i) {
            Cube& cube = level[i];
            const Box3d box = cubeAt(cube.corner, log2Size);
            const Box3d from = motion_->sources(box);
            cube.range = rangeFrom(from);
            cube.outside = isOutside(from, cube.range);
            constexpr double width = 1 << blockLog2;
            for (int k = 0; k < 3; ++k)
                cube.loose |=
                    box.lower[k] - from.lower[k] > width || from.upper[k] - box.upper[k] > width;
        });
        std::erase_if(level, [](const Cube& cube) { return cube.outside; });
        if (log2Size > superLog2 && level.size() > mostSupers)
            throw inputError("velocities move a grid over more than {} cubes of {}^3 voxels",
                             level.size(), std::int64_t{1} << log2Size);
        // Where there is too much to be told apart, bounds stay those of larger cubes.
        const bool whole = log2Size == superLog2 || log2Size == regionLog2 || log2Size == blockLog2;
        const bool enough = log2Size == blockLog2 ||
                            (log2Size == regionLog2 && level.size() > mostRegions) ||
                            (log2Size == superLog2 && level.size() > mostSupers);
        std::vector<Cube> next;
        for (const Cube& cube : level) {
            if (whole && (cube.range.min == cube.range.max || enough)) {
                found.push_back(cube);
                continue;
            }
            const std::int64_t half = std::int64_t{1} << (log2Size - 1);
            for (int i = 0; i < 8; ++i) {
                const Corner corner =
                    cube.corner + Corner{i & 1 ? half : 0, i & 2 ? half : 0, i & 4 ? half : 0};
                if (overlap(cubeAt(corner, log2Size - 1), reach_))
                    next.push_back({corner, log2Size - 1});
            }
        }
        level = std::move(next);
    }
    return found;
}

void MovedRanges::place(const std::vector<Cube>& cubes) {
    if (cubes.empty()) return;
    Box3d all;
    std::unordered_set<std::uint64_t> regions, supers;
    const auto keyOf = [](Corner c, int shift) {
        const auto part = [&](std::int64_t v) {
            return static_cast<std::uint64_t>(v >> shift) & 0x1fffffu;
        };
        return part(c.x) | part(c.y) << 21 | part(c.z) << 42;
    };
    std::size_t uneven = 0, loose = 0;
    for (const Cube& cube : cubes) {
        all.add(cubeAt(cube.corner, cube.log2Size));
        supers.insert(keyOf(cube.corner, superLog2));
        if (cube.log2Size == blockLog2) regions.insert(keyOf(cube.corner, regionLog2));
        if (!(cube.range.min < cube.range.max)) continue;
        ++uneven;
        loose += cube.loose;
    }
    looseShare_ = uneven > 0 ? static_cast<double>(loose) / static_cast<double>(uneven) : 0;
    support_ = {max(all.lower, reach_.lower), min(all.upper, reach_.upper)};
    const auto blockOf = [](Corner c) {
        return Vec3<std::int64_t>{c.x >> blockLog2, c.y >> blockLog2, c.z >> blockLog2}.as<int>();
    };
    const Box3i bounds{blockOf(all.lower.as<std::int64_t>()),
                       blockOf(all.upper.as<std::int64_t>()) - Vec3i{1, 1, 1}};
    double volume = sizeof(Range);
    for (int i = 0; i < 3; ++i) volume *= 1.0 + bounds.upper[i] - bounds.lower[i];
    const bool dense = volume <= static_cast<double>(
                                     BlockTable<Range>::sparseBytes(regions.size(), supers.size()));
    blocks_ = BlockTable<Range>(bounds, blocks_.outside(), dense);
    if (!dense) blocks_.reserve(regions.size(), supers.size());
    for (const Cube& cube : cubes) blocks_.fill(blockOf(cube.corner), cube.log2Size, cube.range);
    blocks_.shrink();
}

}  // namespace woodcock::grid
