// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "woodcock/bake/interval.h"
#include "woodcock/base/vec.h"

namespace woodcock::bake {

// Noises of unit wavelength over space, and over a fourth coordinate, `w`, by which they evolve.
// They use only additions, multiplications, square roots and integer hashes, so that they are the
// same on every machine. Lattice coordinates wrap beyond 2^51.

/// Gradient noise in [-1, 1], zero at lattice points. Perlin 2002, "Improving noise", with hashed
/// gradients instead of a table.
double perlinNoise(Vec3d p, double w, std::uint64_t seed);

/// Its value and its gradient with respect to p.
struct NoiseGradient {
    double value;
    Vec3d gradient;
};
NoiseGradient perlinGradient(Vec3d p, double w, std::uint64_t seed);

/// A bound of the partial derivatives of perlinNoise. Along x it is fade'(t) (B - A) + lerp(A', B')
/// with |A'|, |B'| <= 1, and |A| + |B| <= 2.5 - t for t <= 1/2, as the other two coordinates
/// average to 1/2 at most: fade'(t) (2.5 - t) <= 3.77.
inline constexpr double perlinSlope = 4.78;

/// Gradient noise on a lattice of tetrahedra, in [-1, 1]. Perlin 2001, as Gustavson 2005 explains
/// it.
double simplexNoise(Vec3d p, std::uint64_t seed);

/// Distances, at most 1, to the nearest and the second nearest of random points, one in each unit
/// cell. The points move in their cells with w. Worley 1996.
struct CellDistances {
    double first, second;
};
CellDistances cellNoise(Vec3d p, double w, std::uint64_t seed);

/// The same for many positions in one box; the points of its cells are computed once.
class CellCache {
public:
    CellCache(const Box3d& box, double w, std::uint64_t seed);
    /// cellNoise(p, w, seed), for p in the box.
    CellDistances distances(Vec3d p) const;
    double nearest(Vec3d p) const;  ///< the nearest distance only

private:
    template <bool Two>
    CellDistances search(Vec3d p) const;

    double w_;
    std::uint64_t seed_;
    std::array<std::int64_t, 3> first_{}, size_{};  ///< of the cells
    std::vector<Vec3d> points_;                     ///< none where there would be very many
};

}  // namespace woodcock::bake
