// SPDX-License-Identifier: Apache-2.0
#include "woodcock/bake/noise.h"

#include <array>

#include "woodcock/base/random.h"

namespace woodcock {

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

/// Noises of two slices share their places of zero, so the seed of a slice is its own.
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

CellDistances cellNoise(Vec3d p, double w, std::uint64_t seed) {
    const Lattice at[3]{locate(p.x), locate(p.y), locate(p.z)};
    const Lattice time = locate(w);
    const double blend = fade(time.t);
    double first = 1, second = 1;  // squared
    for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j)
            for (int k = -1; k <= 1; ++k) {
                const std::uint64_t hash =
                    cellHash(at[0].cell + i, at[1].cell + j, at[2].cell + k, seed);
                const auto place = [hash](std::int64_t slice) {
                    RandomStream random(hashOf(hash, static_cast<std::uint64_t>(slice)));
                    const double x = random.uniform(), y = random.uniform();
                    return Vec3d{x, y, random.uniform()};
                };
                Vec3d point = place(time.cell);
                if (blend > 0) point = point * (1 - blend) + place(time.cell + 1) * blend;
                const Vec3d d = point + Vec3d{i - at[0].t, j - at[1].t, k - at[2].t};
                const double square = dot(d, d);
                second = std::min(second, std::max(first, square));
                first = std::min(first, square);
            }
    return {std::sqrt(first), std::sqrt(second)};
}

}  // namespace woodcock
