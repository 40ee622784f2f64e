// SPDX-License-Identifier: Apache-2.0
#include "woodcock/bake/noise.h"

#include <array>

#include "woodcock/base/random.h"

namespace woodcock::bake {

namespace {

struct Lattice {
    std::int64_t cell;
    double t;  ///< in [0, 1)
};
Lattice locate(double v) {
    const double floor = std::floor(std::clamp(v, -0x1p51, 0x1p51));
    return {static_cast<std::int64_t>(floor), std::min(std::max(v - floor, 0.0), 1.0)};
}

std::uint64_t cellHash(std::int64_t x, std::int64_t y, std::int64_t z, std::uint64_t seed) {
    return mixBits((static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u) ^
                   (static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fu) ^
                   (static_cast<std::uint64_t>(z) * 0x165667b19e3779f9u) ^ seed);
}

constexpr std::array<Vec3d, 12> edges{{{1, 1, 0},
                                       {-1, 1, 0},
                                       {1, -1, 0},
                                       {-1, -1, 0},
                                       {1, 0, 1},
                                       {-1, 0, 1},
                                       {1, 0, -1},
                                       {-1, 0, -1},
                                       {0, 1, 1},
                                       {0, -1, 1},
                                       {0, 1, -1},
                                       {0, -1, -1}}};
const Vec3d& edge(std::uint64_t hash) {
    return edges[static_cast<std::size_t>(((hash >> 32) * 12) >> 32)];
}

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }
double fadeSlope(double t) { return 30 * t * t * (t - 1) * (t - 1); }
double lerp(double a, double b, double t) { return a + t * (b - a); }

/// Of one slice of the fourth coordinate.
double perlinSlice(Vec3d p, std::uint64_t seed) {
    const Lattice x = locate(p.x), y = locate(p.y), z = locate(p.z);
    const auto corner = [&](int i, int j, int k) {
        const Vec3d& g = edge(cellHash(x.cell + i, y.cell + j, z.cell + k, seed));
        return g.x * (x.t - i) + g.y * (y.t - j) + g.z * (z.t - k);
    };
    const double u = fade(x.t), v = fade(y.t), s = fade(z.t);
    return lerp(lerp(lerp(corner(0, 0, 0), corner(1, 0, 0), u),
                     lerp(corner(0, 1, 0), corner(1, 1, 0), u), v),
                lerp(lerp(corner(0, 0, 1), corner(1, 0, 1), u),
                     lerp(corner(0, 1, 1), corner(1, 1, 1), u), v),
                s);
}

NoiseGradient gradientSlice(Vec3d p, std::uint64_t seed) {
    const Lattice at[3]{locate(p.x), locate(p.y), locate(p.z)};
    NoiseGradient sum{0, {}};
    for (int corner = 0; corner < 8; ++corner) {
        const int bit[3]{corner & 1, corner >> 1 & 1, corner >> 2};
        const Vec3d& g =
            edge(cellHash(at[0].cell + bit[0], at[1].cell + bit[1], at[2].cell + bit[2], seed));
        const Vec3d d{at[0].t - bit[0], at[1].t - bit[1], at[2].t - bit[2]};
        double weight[3], slope[3];
        for (int i = 0; i < 3; ++i) {
            weight[i] = bit[i] ? fade(at[i].t) : 1 - fade(at[i].t);
            slope[i] = (bit[i] ? 1 : -1) * fadeSlope(at[i].t);
        }
        const double value = dot(g, d), all = weight[0] * weight[1] * weight[2];
        sum.value += all * value;
        sum.gradient +=
            g * all + Vec3d{slope[0] * weight[1] * weight[2], weight[0] * slope[1] * weight[2],
                            weight[0] * weight[1] * slope[2]} *
                          value;
    }
    return sum;
}

/// Noises of two slices are zero at the same points, so each slice has a seed of its own.
std::uint64_t sliceSeed(std::uint64_t seed, std::int64_t slice) {
    return hashOf(seed, static_cast<std::uint64_t>(slice));
}

}  // namespace

double perlinNoise(Vec3d p, double w, std::uint64_t seed) {
    const Lattice time = locate(w);
    const double now = perlinSlice(p, sliceSeed(seed, time.cell));
    if (time.t == 0) return std::clamp(now, -1.0, 1.0);
    const double next = perlinSlice(p, sliceSeed(seed, time.cell + 1));
    return std::clamp(lerp(now, next, fade(time.t)), -1.0, 1.0);
}

NoiseGradient perlinGradient(Vec3d p, double w, std::uint64_t seed) {
    const Lattice time = locate(w);
    const NoiseGradient now = gradientSlice(p, sliceSeed(seed, time.cell));
    if (time.t == 0) return now;
    const NoiseGradient next = gradientSlice(p, sliceSeed(seed, time.cell + 1));
    const double s = fade(time.t);
    return {lerp(now.value, next.value, s), now.gradient * (1 - s) + next.gradient * s};
}

double simplexNoise(Vec3d p, std::uint64_t seed) {
    // Skewing by 1/3 turns tetrahedra into halves of cubes' corners; 1/6 undoes it.
    const double skew = (p.x + p.y + p.z) / 3;
    const Lattice cell[3]{locate(p.x + skew), locate(p.y + skew), locate(p.z + skew)};
    const double unskew = static_cast<double>(cell[0].cell + cell[1].cell + cell[2].cell) / 6;
    Vec3d d;  // from the cell's first corner
    for (int i = 0; i < 3; ++i) d[i] = p[i] - (static_cast<double>(cell[i].cell) - unskew);
    // The tetrahedron's corners are reached one axis after the other, the largest offset first.
    const int rank[3]{(d.x < d.y) + (d.x < d.z), (d.y <= d.x) + (d.y < d.z),
                      (d.z <= d.x) + (d.z <= d.y)};
    double sum = 0;
    for (int corner = 0; corner < 4; ++corner) {
        std::int64_t at[3];
        Vec3d e;
        for (int i = 0; i < 3; ++i) {
            const int step = rank[i] < corner;
            at[i] = cell[i].cell + step;
            e[i] = d[i] - step + corner / 6.0;
        }
        const double t = 0.5 - dot(e, e);
        if (t > 0) sum += t * t * t * t * dot(edge(cellHash(at[0], at[1], at[2], seed)), e);
    }
    constexpr double scale = 76.9;  // the largest sum is a little below its inverse
    return std::clamp(sum * scale, -1.0, 1.0);
}

namespace {

/// The point of a cell, from the cell's lower corner.
Vec3d cellPoint(std::int64_t x, std::int64_t y, std::int64_t z, const Lattice& time,
                std::uint64_t seed) {
    const std::uint64_t hash = cellHash(x, y, z, seed);
    const auto place = [hash](std::int64_t slice) {
        RandomStream random(hashOf(hash, static_cast<std::uint64_t>(slice)));
        const double u = random.uniform(), v = random.uniform();
        return Vec3d{u, v, random.uniform()};
    };
    const double blend = fade(time.t);
    const Vec3d now = place(time.cell);
    return blend > 0 ? now * (1 - blend) + place(time.cell + 1) * blend : now;
}

/// The nearest two points of the 27 cells around p, or only the nearest (as both). `pointOf(i, j,
/// k)` gives the point of the cell at that offset. Cells that cannot hold a nearer point are
/// skipped.
template <bool Two, class PointOf>
CellDistances nearestPoints(const Lattice (&at)[3], const PointOf& pointOf) {
    double first = 1, second = 1;  // squared
    double gap[3][3];              // squared, to the cells below, at and above along each axis
    for (int a = 0; a < 3; ++a) {
        gap[a][0] = at[a].t * at[a].t, gap[a][1] = 0;
        gap[a][2] = (1 - at[a].t) * (1 - at[a].t);
    }
    constexpr int order[]{1, 0, 2};  // its own cell first
    for (const int i : order)
        for (const int j : order)
            for (const int k : order) {
                if (gap[0][i] + gap[1][j] + gap[2][k] > (Two ? second : first)) continue;
                const Vec3d d = pointOf(i - 1, j - 1, k - 1) +
                                Vec3d{i - 1 - at[0].t, j - 1 - at[1].t, k - 1 - at[2].t};
                const double square = dot(d, d);
                if (Two) second = std::min(second, std::max(first, square));
                first = std::min(first, square);
            }
    const double nearest = std::sqrt(first);
    return {nearest, Two ? std::sqrt(second) : nearest};
}

}  // namespace

CellDistances cellNoise(Vec3d p, double w, std::uint64_t seed) {
    const Lattice at[3]{locate(p.x), locate(p.y), locate(p.z)};
    const Lattice time = locate(w);
    return nearestPoints<true>(at, [&](int i, int j, int k) {
        return cellPoint(at[0].cell + i, at[1].cell + j, at[2].cell + k, time, seed);
    });
}

CellCache::CellCache(const Box3d& box, double w, std::uint64_t seed) : w_(w), seed_(seed) {
    constexpr double most = 4096;
    double count = 1;
    for (int a = 0; a < 3; ++a) {
        const std::int64_t low = locate(box.lower[a]).cell - 1,
                           high = locate(box.upper[a]).cell + 1;
        first_[static_cast<std::size_t>(a)] = low;
        size_[static_cast<std::size_t>(a)] = high - low + 1;
        count *= static_cast<double>(high - low + 1);
    }
    if (!(count <= most)) return;
    const Lattice time = locate(w);
    points_.reserve(static_cast<std::size_t>(count));
    for (std::int64_t x = 0; x < size_[0]; ++x)
        for (std::int64_t y = 0; y < size_[1]; ++y)
            for (std::int64_t z = 0; z < size_[2]; ++z)
                points_.push_back(
                    cellPoint(first_[0] + x, first_[1] + y, first_[2] + z, time, seed));
}

template <bool Two>
CellDistances CellCache::search(Vec3d p) const {
    const Lattice at[3]{locate(p.x), locate(p.y), locate(p.z)};
    const Vec3d* const own =
        points_.data() + ((at[0].cell - first_[0]) * size_[1] + at[1].cell - first_[1]) * size_[2] +
        at[2].cell - first_[2];
    return nearestPoints<Two>(
        at, [&](int i, int j, int k) { return own[(i * size_[1] + j) * size_[2] + k]; });
}

CellDistances CellCache::distances(Vec3d p) const {
    return points_.empty() ? cellNoise(p, w_, seed_) : search<true>(p);
}

double CellCache::nearest(Vec3d p) const {
    return points_.empty() ? cellNoise(p, w_, seed_).first : search<false>(p).first;
}

}  // namespace woodcock::bake
