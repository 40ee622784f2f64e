// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "woodcock/medium/look_up.h"

namespace woodcock::medium {

// The density of a part along a ray, piece by piece. Along each piece it is one polynomial, whose
// integral is known. Each kind of piece says the integral of a channel of f over [a, b] of the
// ray, which must lie within the piece, and may say that it is the same in all channels.

/// f is constant: outside of the support, in a homogeneous box, and where a cell's bounds agree.
struct ConstantPiece {
    Rgb f;
    bool grey() const { return false; }
    double integral(double a, double b, int channel) const {
        // An endless piece of nothing is nothing.
        return f[channel] > 0 ? (b - a) * double{f[channel]} : 0;
    }
};

/// Inside of one cell of the voxel lattice f is trilinear: a cubic along the ray, of which
/// two-point Gauss-Legendre quadrature is exact.
class LatticePiece {
public:
    LatticePiece(const grid::Field& field, const grid::IndexRay& ray, Vec3i cell)
        : ray_(ray), cell_(cell.as<double>()), channels_(field.channels()) {
        if (grey())
            corners_[0] = field.cellVoxels(cell)[0];
        else
            corners_ = field.cellVoxels<3>(cell);
    }

    bool grey() const { return channels_ == 1; }
    double integral(double a, double b, int channel) const {
        constexpr double node = 0.57735026918962576;
        const double middle = (a + b) / 2, half = (b - a) / 2;
        const auto& v = corners_[grey() ? 0 : static_cast<std::size_t>(channel)];
        return half * (at(v, middle - half * node) + at(v, middle + half * node));
    }

private:
    double at(const std::array<float, 8>& v, double t) const {
        const Vec3d p = ray_.at(t) - cell_;
        const auto lerp = [](double u, double a, double b) { return a + u * (b - a); };
        return lerp(p.z, lerp(p.y, lerp(p.x, v[0], v[1]), lerp(p.x, v[2], v[3])),
                    lerp(p.y, lerp(p.x, v[4], v[5]), lerp(p.x, v[6], v[7])));
    }

    const grid::IndexRay& ray_;
    Vec3d cell_;
    int channels_;
    std::array<std::array<float, 8>, 3> corners_;
};

/// Of a part that moves f is no polynomial along a ray. It is integrated at the ray's time by eight
/// points for each voxel's width: not exact.
struct MovedPiece {
    const MediumPart& part;
    const grid::IndexRay& ray;
    float time;

    bool grey() const { return part.field()->channels() == 1; }
    double integral(double a, double b, int channel) const {
        const double step = b - a;
        const auto points =
            static_cast<int>(std::ceil(std::max(1.0, 8 * step * length(ray.direction))));
        double sum = 0;
        for (int i = 0; i < points; ++i)
            sum += double{
                densityAt<3>(part, ray.at(a + step * (i + 0.5) / points), time, InFull{})[channel]};
        return sum * step / points;
    }
};

/// The integrals of N channels of a piece's f over [a, b] of the ray.
template <int N, class Piece>
std::array<double, N> integrals(const Piece& piece, double a, double b) {
    std::array<double, N> of;
    of.fill(piece.integral(a, b, 0));
    if (!piece.grey())
        for (int c = 1; c < N; ++c) of[static_cast<std::size_t>(c)] = piece.integral(a, b, c);
    return of;
}

/// Visits the unit cells of a lattice that [t0, t1] of a ray crosses, in order: visit(cell, t0, t1)
/// until it returns false. `shift`: of the lattice's planes against the integers. False: ended so.
template <class Visit>
bool walkLattice(const grid::IndexRay& ray, double shift, double t0, double t1, Visit&& visit) {
    const Vec3d start = ray.at(t0) + Vec3d{shift, shift, shift};
    Vec3i cell = floorToInt(start), step;
    Vec3d inverse, face;
    const auto faceAhead = [&](int i) {
        return (cell[i] + (step[i] > 0 ? 1 : 0) - shift - ray.origin[i]) * inverse[i];
    };
    for (int i = 0; i < 3; ++i) {
        const double d = ray.direction[i];
        step[i] = d < 0 ? -1 : 1;
        inverse[i] = 1 / d;
        face[i] = std::abs(d) > 1e-290 ? faceAhead(i) : std::numeric_limits<double>::infinity();
    }
    for (double t = t0; t < t1;) {
        const int axis = face.x < face.y ? (face.x < face.z ? 0 : 2) : (face.y < face.z ? 1 : 2);
        const double end = std::min(std::max(face[axis], t), t1);
        if (end > t && !visit(cell, t, end)) return false;
        if (!(face[axis] < t1)) break;
        t = end;
        cell[axis] += step[axis];
        face[axis] = faceAhead(axis);
    }
    return true;
}

/// Visits the pieces of [0, length] of a ray, a world ray in the part's index space, in order:
/// visit(piece, t0, t1), with a piece of one of the kinds above, until it returns false. Between
/// pieces f is 0. `time`: of the ray, within the shutter. False: ended so.
template <class Visit>
bool walkDensity(const MediumPart& part, const grid::IndexRay& ray, double length, float time,
                 Visit&& visit) {
    PartWalk walk(part, ray, length);
    grid::Segment s;
    while (walk.next(s)) {
        if (s.range.min == s.range.max) {
            if (s.range.max > 0 && !visit(ConstantPiece{Rgb(s.range.max)}, s.t0, s.t1))
                return false;
            continue;
        }
        if (!walk.insideSupport(s)) {
            const grid::Field& field = *part.field();
            if (!visit(ConstantPiece{Rgb::map(
                           [&](int c) { return field.background(field.channels() == 1 ? 0 : c); })},
                       s.t0, s.t1))
                return false;
            continue;
        }
        if (part.moved()) {
            if (!visit(MovedPiece{part, ray, time}, s.t0, s.t1)) return false;
            continue;
        }
        const grid::Field& field = *part.field();
        const bool nearest = field.lookup() == grid::Lookup::Nearest;
        const auto inCell = [&](Vec3i cell, double t0, double t1) {
            if (!nearest) return visit(LatticePiece(field, ray, cell), t0, t1);
            return visit(ConstantPiece{Rgb::map([&](int c) {
                             return field.voxel(cell, field.channels() == 1 ? 0 : c);
                         })},
                         t0, t1);
        };
        if (!walkLattice(ray, nearest ? 0.5 : 0, s.t0, s.t1, inCell)) return false;
    }
    return true;
}

}  // namespace woodcock::medium
