// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/majorants.h"

#include <tbb/parallel_for.h>

#include <unordered_set>

#include "woodcock/base/huge_pages.h"
#include "woodcock/base/random.h"
#include "woodcock/base/statistics.h"
#include "woodcock/grid/block_ranges.h"
#include "woodcock/grid/cell_walk.h"

namespace woodcock::grid {

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

/// The values of block `b` and of the layer on its + sides, x fastest.
std::array<Range, 729> voxelRanges(const Field& field, Vec3i b) {
    std::vector<Field::BlockVoxels> blocks;
    for (int i = 0; i < 8; ++i) blocks.emplace_back(field, b + Vec3i{i & 1, i >> 1 & 1, i >> 2});
    std::array<Range, 729> voxels;
    std::size_t i = 0;
    for (int z = 0; z < 9; ++z)
        for (int y = 0; y < 9; ++y)
            for (int x = 0; x < 9; ++x, ++i) {
                const auto& block =
                    blocks[static_cast<std::size_t>(x >> 3 | y >> 3 << 1 | z >> 3 << 2)];
                const float first = block({x, y, z});
                voxels[i] = {first, first};
                for (int c = 1; c < field.channels(); ++c) {
                    const float v = block({x, y, z}, c);
                    voxels[i].add({v, v});
                }
            }
    return voxels;
}

/// Nine layers along one axis become the four cells that reach over three of them each. The faster
/// axes have `inner` entries in all, the slower ones `outer`.
template <std::size_t outer, std::size_t inner>
std::array<Range, outer * 4 * inner> cellsOfLayers(const std::array<Range, outer * 9 * inner>& in) {
    std::array<Range, outer * 4 * inner> cells;
    for (std::size_t o = 0; o < outer; ++o)
        for (std::size_t k = 0; k < 4; ++k)
            for (std::size_t i = 0; i < inner; ++i) {
                const Range* const layer = &in[(o * 9 + 2 * k) * inner + i];
                Range r = layer[0];
                r.add(layer[inner]);
                r.add(layer[2 * inner]);
                cells[(o * 4 + k) * inner + i] = r;
            }
    return cells;
}

/// Ranges of the 64 cells of 2^3 voxels inside block `b`, halo included.
std::array<Range, 64> finestRanges(const Field& field, Vec3i b) {
    return cellsOfLayers<16, 1>(cellsOfLayers<4, 9>(cellsOfLayers<1, 81>(voxelRanges(field, b))));
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

Range scaled(Range r, const MajorantGrid::Options& options) {
    return {r.min, static_cast<float>(r.max * options.scale)};
}

/// Bounds of the cells that a brick is split into.
struct Split {
    std::vector<Range> cells;
    bool finest = false;  ///< 64 cells of 2^3 voxels, else 8 of 4^3
};

/// The cheapest way to split a block whose own cost is `whole`, of its 64 finest cells; no cells
/// where none is cheaper.
Split cheapestSplit(std::array<Range, 64> fine, double whole,
                    const MajorantGrid::Options& options) {
    std::array<Range, 8> coarse = halved(fine);
    double fineCost = 0, coarseCost = 0;
    for (Range& r : fine) {
        r = scaled(r, options);
        fineCost += octantShare * octantShare * cellCost(r, 1, options.depthPerVoxel);
    }
    for (Range& r : coarse) {
        r = scaled(r, options);
        coarseCost += octantShare * cellCost(r, 2, options.depthPerVoxel);
    }
    const bool finest = fineCost < coarseCost && options.smallestLog2 <= 1;
    if (!((finest ? fineCost : coarseCost) < whole)) return {};
    return finest ? Split{{fine.begin(), fine.end()}, true}
                  : Split{{coarse.begin(), coarse.end()}, false};
}

/// A region of 16^3 blocks as an octree: cubes of 1, 2, 4, 8 and 16 blocks, x fastest.
class RegionTree {
public:
    /// `blocks`: the first level.
    RegionTree(std::vector<Node> blocks, const MajorantGrid::Options& options) {
        levels_[0] = std::move(blocks);
        for (int level = 1; level <= 4; ++level) build(level, options);
    }

    /// The largest merged cube around a block, and its level; null: the block stays alone.
    std::pair<const Node*, int> cellOf(Vec3i block) const {
        for (int level = 4; level >= 1; --level) {
            const Node& node = at(level, block.x >> level, block.y >> level, block.z >> level);
            if (node.merged) return {&node, level};
        }
        return {nullptr, 0};
    }

private:
    const Node& at(int level, int x, int y, int z) const {
        const int n = 16 >> level;
        return levels_[static_cast<std::size_t>(level)]
                      [static_cast<std::size_t>(x + n * (y + n * z))];
    }

    void build(int level, const MajorantGrid::Options& options) {
        const int n = 16 >> level;
        auto& nodes = levels_[static_cast<std::size_t>(level)];
        nodes.reserve(static_cast<std::size_t>(n * n * n));
        for (int i = 0; i < n * n * n; ++i)
            nodes.push_back(parent(level, {i % n, i / n % n, i / n / n}, options));
    }

    Node parent(int level, Vec3i at, const MajorantGrid::Options& options) const {
        Node node;
        double split = 0;
        for (int k = 0; k < 8; ++k) {
            const Node& child = this->at(level - 1, 2 * at.x + (k & 1), 2 * at.y + (k >> 1 & 1),
                                         2 * at.z + (k >> 2));
            if (!child.used) continue;
            if (!node.used) node.range = child.range;
            node.used = true;
            node.range.add(child.range);
            node.merged &= child.merged;
            split += octantShare * child.cost;
        }
        if (!node.used) return node;
        node.cost = cellCost(node.range, blockLog2 + level, options.depthPerVoxel);
        const bool forced = blockLog2 + level <= options.smallestLog2;
        if (!forced && !(node.merged && node.cost < split)) {
            node.merged = false;
            node.cost = std::min(node.cost, split);
        }
        return node;
    }

    std::array<std::vector<Node>, 5> levels_;
};

}  // namespace

MajorantGrid::MajorantGrid(const Field& field, const Options& options)
    : MajorantGrid(
          blockRanges(field), [&](Vec3i block) { return finestRanges(field, block); }, options) {}

MajorantGrid::MajorantGrid(const BlockTable<Range>& blocks, const FinestRanges& finest,
                           const Options& options) {
    table_ = blocks.map<Entry>([&](Range r) { return Entry{scaled(r, options), blockLog2}; });
    splitLooseBlocks(finest, options);
    mergeBlocks(options);
}

void MajorantGrid::splitLooseBlocks(const FinestRanges& finest, const Options& options) {
    if (options.smallestLog2 >= blockLog2) return;
    constexpr double leastGain = 2 * stepCost;
    const auto costOf = [&](const Entry& e) {
        return cellCost(e.range, blockLog2, options.depthPerVoxel);
    };
    std::vector<Vec3i> blocks;
    table_.forEach([&](Vec3i b, int log2Size, const Entry& e) {
        if (log2Size == blockLog2 && e.range.max > e.range.min && costOf(e) > leastGain)
            blocks.push_back(b);
    });
    std::vector<Split> splits(blocks.size());
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
        const double whole = costOf(*table_.find(blocks[i]).value);
        splits[i] = cheapestSplit(finest(blocks[i]), whole, options);
    });
    std::size_t parts = 0;
    for (const Split& split : splits) parts += split.cells.size();
    reserveLarge(parts_, parts);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        if (splits[i].cells.empty()) continue;
        table_.at(blocks[i]).code =
            ~static_cast<std::int32_t>(parts_.size() * 2 + (splits[i].finest ? 1 : 0));
        for (const Range r : splits[i].cells) parts_.push_back({roundDown(r.min), roundUp(r.max)});
    }
}

void MajorantGrid::mergeBlocks(const Options& options) {
    std::vector<Vec3i> regions;
    std::unordered_set<std::uint64_t> seen;
    table_.forEach([&](Vec3i b, int log2Size, const Entry&) {
        if (log2Size != blockLog2) return;
        const auto part = [](int v) { return static_cast<std::uint64_t>(v >> 4) & 0x1fffffu; };
        if (seen.insert(part(b.x) | part(b.y) << 21 | part(b.z) << 42).second)
            regions.push_back({b.x & ~15, b.y & ~15, b.z & ~15});
    });
    const auto inside = [&](Vec3i b) {
        const Box3i box = table_.bounds();
        return !table_.dense() || (b.x >= box.lower.x && b.y >= box.lower.y && b.z >= box.lower.z &&
                                   b.x <= box.upper.x && b.y <= box.upper.y && b.z <= box.upper.z);
    };
    const auto blockOf = [](int i) { return Vec3i{i & 15, i >> 4 & 15, i >> 8}; };
    tbb::parallel_for(std::size_t{0}, regions.size(), [&](std::size_t region) {
        const Vec3i origin = regions[region];
        std::vector<Node> blocks(4096);
        for (int i = 0; i < 4096; ++i) {
            const Vec3i b = origin + blockOf(i);
            if (!inside(b)) continue;
            const Entry& e = *table_.find(b).value;
            blocks[static_cast<std::size_t>(i)] = {
                e.range, cellCost(e.range, blockLog2, options.depthPerVoxel), e.code >= 0, true};
        }
        const RegionTree tree(std::move(blocks), options);
        for (int i = 0; i < 4096; ++i) {
            const Vec3i at = blockOf(i);
            if (!inside(origin + at)) continue;
            if (const auto [cell, level] = tree.cellOf(at); cell)
                table_.at(origin + at) = {cell->range, blockLog2 + level};
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

}  // namespace woodcock::grid
