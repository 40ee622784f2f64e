// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/majorants.h"

#include <tbb/parallel_for.h>

#include <unordered_set>

#include "woodcock/base/random.h"
#include "woodcock/base/statistics.h"
#include "woodcock/grid/block_ranges.h"
#include "woodcock/grid/cell_walk.h"

namespace woodcock {

namespace {

/// Cost of a random ray crossing a cube that is one cell: a step, and collisions in proportion to
/// the cube's mean chord (4V/S = 2/3 of its width). The distance walk collides at the rate of the
/// maximum, the shadow walk at maximum - minimum; both count, half each.
double cellCost(Range r, int log2Size, double depthPerVoxel) {
    const double chord = std::ldexp(2.0 / 3.0, log2Size) * depthPerVoxel;
    return MajorantGrid::stepCost + chord * (r.max - 0.5 * r.min);
}

/// A quarter of a cube's surface is an octant's: a ray that crosses the cube crosses two of them.
constexpr double octantShare = 0.25;

struct Node {
    Range range;
    double cost = 0;
    bool merged = true;
    bool used = false;  // inside the table's bounds
};

std::uint16_t roundDown(float v) {
    std::uint32_t bits = std::bit_cast<std::uint32_t>(v);
    if ((bits & 0xffff) && v < 0) bits += 0x10000;
    return static_cast<std::uint16_t>(bits >> 16);
}
std::uint16_t roundUp(float v) {
    std::uint32_t bits = std::bit_cast<std::uint32_t>(v);
    if ((bits & 0xffff) && v > 0) bits += 0x10000;
    return static_cast<std::uint16_t>(bits >> 16);
}

/// Ranges of the 64 cells of 2^3 voxels inside block `b`, halo included.
std::array<Range, 64> finestRanges(const Field& field, Vec3i b) {
    std::vector<Field::BlockVoxels> blocks;  // b and its neighbours on the + sides
    for (int i = 0; i < 8; ++i) blocks.emplace_back(field, b + Vec3i{i & 1, i >> 1 & 1, i >> 2});
    std::array<Range, 729> voxels;
    for (int i = 0; i < 729; ++i) {
        const Vec3i v{i % 9, i / 9 % 9, i / 81};
        const auto& block = blocks[static_cast<std::size_t>(v.x / 8 + v.y / 8 * 2 + v.z / 8 * 4)];
        const float first = block(v);
        Range r{first, first};
        for (int c = 1; c < field.channels(); ++c) r.add({block(v, c), block(v, c)});
        voxels[static_cast<std::size_t>(i)] = r;
    }
    std::array<Range, 64> cells;
    for (int i = 0; i < 64; ++i) {
        const int x = (i & 3) * 2, y = (i >> 2 & 3) * 2, z = (i >> 4) * 2;
        Range r = voxels[static_cast<std::size_t>(x + 9 * y + 81 * z)];
        for (int j = 0; j < 27; ++j)
            r.add(voxels[static_cast<std::size_t>(x + j % 3 + 9 * (y + j / 3 % 3) +
                                                  81 * (z + j / 9))]);
        cells[static_cast<std::size_t>(i)] = r;
    }
    return cells;
}

/// The eight cells of 4^3 voxels from the 64 of 2^3.
std::array<Range, 8> halved(const std::array<Range, 64>& fine) {
    std::array<Range, 8> coarse;
    for (std::size_t i = 0; i < 8; ++i) {
        const std::size_t first = (i & 1) * 2 + (i >> 1 & 1) * 8 + (i >> 2) * 32;
        coarse[i] = fine[first];
        for (std::size_t j = 1; j < 8; ++j)
            coarse[i].add(fine[first + (j & 1) + (j >> 1 & 1) * 4 + (j >> 2) * 16]);
    }
    return coarse;
}

}  // namespace

MajorantGrid::MajorantGrid(const Field& field, const Options& options) {
    const auto scaled = [&](Range r) {
        return Range{r.min, static_cast<float>(r.max * options.scale)};
    };
    table_ = blockRanges(field).map<Entry>([&](Range r) { return Entry{scaled(r), blockLog2}; });

    // Split bricks whose bounds are loose enough to pay for it.
    std::vector<Vec3i> blocks;
    std::unordered_set<std::uint64_t> seen;
    std::vector<Vec3i> regions;
    table_.forEach([&](Vec3i b, int log2Size, const Entry& e) {
        if (log2Size != blockLog2) return;
        const auto part = [](int v) { return static_cast<std::uint64_t>(v >> 4) & 0x1fffffu; };
        if (seen.insert(part(b.x) | part(b.y) << 21 | part(b.z) << 42).second)
            regions.push_back({b.x & ~15, b.y & ~15, b.z & ~15});
        const double most = 2 * stepCost;  // at least this much must be to gain
        if (options.smallestLog2 < blockLog2 && e.range.max > e.range.min &&
            cellCost(e.range, blockLog2, options.depthPerVoxel) > most)
            blocks.push_back(b);
    });
    struct Split {
        std::vector<Part> parts;
        bool finest = false;
        double cost = 0;
    };
    std::vector<Split> splits(blocks.size());
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
        const std::array<Range, 64> fine = finestRanges(field, blocks[i]);
        const std::array<Range, 8> coarse = halved(fine);
        double fineCost = 0, coarseCost = 0;
        for (Range r : fine)
            fineCost += octantShare * octantShare * cellCost(scaled(r), 1, options.depthPerVoxel);
        for (Range r : coarse)
            coarseCost += octantShare * cellCost(scaled(r), 2, options.depthPerVoxel);
        const double whole =
            cellCost(table_.find(blocks[i]).value->range, blockLog2, options.depthPerVoxel);
        Split& s = splits[i];
        s.finest = fineCost < coarseCost && options.smallestLog2 <= 1;
        s.cost = s.finest ? fineCost : coarseCost;
        if (!(s.cost < whole)) return;
        const std::span<const Range> ranges =
            s.finest ? std::span<const Range>(fine) : std::span<const Range>(coarse);
        for (Range r : ranges) {
            const Range bounds = scaled(r);
            s.parts.push_back({roundDown(bounds.min), roundUp(bounds.max)});
        }
    });
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        if (splits[i].parts.empty()) continue;
        table_.at(blocks[i]).code =
            ~static_cast<std::int32_t>(parts_.size() * 2 + (splits[i].finest ? 1 : 0));
        parts_.insert(parts_.end(), splits[i].parts.begin(), splits[i].parts.end());
    }

    // Merge blocks into larger cells, region by region, where a step saved is worth the looseness.
    const auto inside = [&](Vec3i b) {
        const Box3i box = table_.bounds();
        return !table_.dense() || (b.x >= box.lower.x && b.y >= box.lower.y && b.z >= box.lower.z &&
                                   b.x <= box.upper.x && b.y <= box.upper.y && b.z <= box.upper.z);
    };
    tbb::parallel_for(std::size_t{0}, regions.size(), [&](std::size_t i) {
        const Vec3i origin = regions[i];
        std::array<std::vector<Node>, 5> levels;  // cubes of 1, 2, 4, 8, 16 blocks
        levels[0].resize(4096);
        for (int j = 0; j < 4096; ++j) {
            const Vec3i b = origin + Vec3i{j & 15, j >> 4 & 15, j >> 8};
            if (!inside(b)) continue;
            const Entry& e = *table_.find(b).value;
            levels[0][static_cast<std::size_t>(j)] = {
                e.range, cellCost(e.range, blockLog2, options.depthPerVoxel), e.code >= 0, true};
        }
        for (int level = 1; level <= 4; ++level) {
            const int n = 16 >> level;
            auto& nodes = levels[static_cast<std::size_t>(level)];
            const auto& below = levels[static_cast<std::size_t>(level - 1)];
            nodes.resize(static_cast<std::size_t>(n * n * n));
            for (int j = 0; j < n * n * n; ++j) {
                Node& node = nodes[static_cast<std::size_t>(j)];
                double split = 0;
                for (int k = 0; k < 8; ++k) {
                    const int x = 2 * (j % n) + (k & 1), y = 2 * (j / n % n) + (k >> 1 & 1),
                              z = 2 * (j / n / n) + (k >> 2);
                    const Node& child =
                        below[static_cast<std::size_t>(x + 2 * n * (y + 2 * n * z))];
                    if (!child.used) continue;
                    if (!node.used) node.range = child.range;
                    node.used = true;
                    node.range.add(child.range);
                    node.merged &= child.merged;
                    split += octantShare * child.cost;
                }
                if (!node.used) continue;
                node.cost = cellCost(node.range, blockLog2 + level, options.depthPerVoxel);
                const bool forced = blockLog2 + level <= options.smallestLog2;
                if (!forced && !(node.merged && node.cost < split)) {
                    node.merged = false;
                    node.cost = std::min(node.cost, split);
                }
            }
        }
        for (int j = 0; j < 4096; ++j) {
            const Vec3i at{j & 15, j >> 4 & 15, j >> 8};
            for (int level = 4; level >= 1; --level) {
                const int n = 16 >> level;
                const Node& node = levels[static_cast<std::size_t>(level)][static_cast<std::size_t>(
                    (at.x >> level) + n * ((at.y >> level) + n * (at.z >> level)))];
                if (!node.merged || !inside(origin + at)) continue;
                table_.at(origin + at) = {node.range, blockLog2 + level};
                break;
            }
        }
    });
}

double MajorantGrid::varyingBlocks() const {
    double count = 0;
    table_.forEach([&](Vec3i, int log2Size, const Entry& e) {
        if (e.range.min < e.range.max) count += std::ldexp(1.0, 3 * (log2Size - blockLog2));
    });
    return count;
}

MajorantStatistics majorantStatistics(const Field& field, const MajorantGrid& majorants, int rays) {
    MajorantStatistics result;
    if (field.support().empty()) return result;
    const Box3d& box = field.support();
    const Vec3d centre = box.centre();
    const double radius = length(box.size()) / 2;
    RandomStream random(hashOf(0x6d616a));
    Moments segments;
    Moments bound, value;
    std::vector<std::pair<double, double>> sums;
    const auto onSphere = [&] {
        const double z = 2 * random.uniform() - 1, phi = 2 * pi * random.uniform();
        const double r = std::sqrt(std::max(0.0, 1 - z * z));
        return Vec3d{r * std::cos(phi), r * std::sin(phi), z};
    };
    constexpr double mostWork = 1 << 25;  // of segments and look-ups: a second
    double work = 0;
    for (int i = 0; i < rays && work < mostWork; ++i) {
        const Vec3d a = centre + onSphere() * radius, b = centre + onSphere() * radius;
        if (a == b) continue;
        const IndexRay ray{a, normalize(b - a)};
        double t0 = 0, t1 = length(b - a);
        if (!clip(ray, box, t0, t1)) continue;
        CellWalk walk(majorants, box, ray, t0, t1);
        Segment s;
        int count = 0;
        double upper = 0, mean = 0;
        while (walk.next(s)) {
            ++count, ++work;
            const double l = s.t1 - s.t0;
            upper += l * s.range.max;
            if (s.range.min == s.range.max) {
                mean += l * s.range.min;
                continue;
            }
            const int samples = 1 + static_cast<int>(std::min(l, 512.0));
            work += samples;
            for (int k = 0; k < samples; ++k)
                mean += l / samples *
                        field.stochastic(ray.at(s.t0 + l * (k + random.uniform()) / samples),
                                         random.bits());
        }
        segments.add(count);
        bound.add(upper), value.add(mean);
        sums.emplace_back(upper, mean);
    }
    result.rays = segments.count();
    result.segmentsPerRay = segments.mean(), result.segmentsError = segments.standardError();
    if (value.mean() > 0) {
        const double ratio = bound.mean() / value.mean();
        Moments residual;  // a ratio of means: its error by linearisation
        for (const auto& [u, m] : sums) residual.add((u - ratio * m) / value.mean());
        result.majorantOverMean = ratio, result.majorantOverMeanError = residual.standardError();
    }
    return result;
}

}  // namespace woodcock
