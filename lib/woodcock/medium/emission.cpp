// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/emission.h"

#include "woodcock/base/error.h"
#include "woodcock/grid/moved_ranges.h"
#include "woodcock/medium/look_up.h"

namespace woodcock::medium {

void moveToRest(const MovingTransform& motion, float time, Vec3d& origin, Vec3d& direction) {
    const Affine3d rest = motion.at(double{time}).inverse();
    origin = rest.point(origin), direction = rest.vector(direction);
}
void moveToRest(const MovingTransform& motion, float time, Vec3d& point) {
    point = motion.at(double{time}).inverse().point(point);
}

EmissionPart::EmissionPart(Description description) : d_(std::move(description)) {
    const double determinant = d_.worldFromIndex.determinant();
    if (!std::isfinite(determinant) || determinant == 0)
        throw inputError("a volume's transform is singular: its determinant is {}", determinant);
    for (int c = 0; c < 3; ++c)
        if (!(d_.scale[c] >= 0 && std::isfinite(d_.scale[c])))
            throw inputError("emission is {}; expected finite numbers >= 0", d_.scale[c]);
    indexFromWorld_ = d_.worldFromIndex.inverse();
    largestScale_ = d_.scale.maximum();
    if (!d_.field) {
        support_ = extent_ = d_.box;
        return;
    }
    const grid::Field& field = *d_.field;
    for (int c = 0; c < field.channels(); ++c)
        if (field.background(c) != 0) {
            background_ = std::max(background_, std::abs(double{field.background(c)}));
            if (field.limits()) continue;
            throw inputError(
                "an emission grid's background is {}; expected 0: a medium that emits everywhere "
                "is infinitely bright",
                field.background(c));
        }
    // As if the brightest voxel were one collision wide: cells that separate bright from dark, and
    // few others.
    const double largest = std::max(std::abs(field.range().min), std::abs(field.range().max));
    const grid::MajorantGrid::Options options{largest > 0 ? 1 / largest : 1, 1, 1};
    if (d_.motion) {
        const grid::MovedRanges moved(d_.field, d_.motion);
        support_ = extent_ = moved.support();
        background_ = 0;
        majorants_ = {moved.blocks(), [&](Vec3i block) { return moved.finest(block); }, options};
    } else {
        support_ = field.support(), extent_ = field.extent();
        majorants_ = grid::MajorantGrid(field, options);
    }
}

Rgb EmissionPart::value(Vec3d world, float time) const {
    if (d_.movement) moveToRest(*d_.movement, time, world);
    const Vec3d p = indexFromWorld_.point(world);
    if (!d_.field) return support_.contains(p) ? d_.scale : Rgb(0.0f);
    const bool ends = d_.field->limits() || d_.motion;
    if (extent_.empty() || (ends && !extent_.contains(p))) return Rgb(0.0f);
    return d_.scale * glowAt(*this, p, time);
}

std::optional<EmissionPoint> EmissionSampler::sample(std::span<const EmissionPart> parts,
                                                     const EmissionQuery& q) {
    const double extinction = q.extinction;
    pieces_.clear();
    double first = std::numeric_limits<double>::infinity();
    for (const EmissionPart& part : parts)
        part.walk(q.origin, q.direction, q.time, q.tMax, [&](double t0, double t1, double bound) {
            pieces_.push_back({.part = &part, .t0 = t0, .t1 = t1, .bound = bound});
            first = std::min(first, t0);
        });
    double even = 0, dimmed = 0;
    for (Piece& p : pieces_) {
        const double length = p.t1 - p.t0;
        p.even = p.bound * length;
        p.dimmed = extinction > 0 ? p.bound * std::exp(-extinction * (p.t0 - first)) *
                                        -std::expm1(-extinction * length) / extinction
                                  : p.even;
        even += p.even, dimmed += p.dimmed;
    }
    if (!(even > 0 && dimmed > 0)) return {};

    const bool byDimmed = q.u >= 0.5;
    double left = (byDimmed ? 2 * q.u - 1 : 2 * q.u) * (byDimmed ? dimmed : even);
    const auto weightOf = [&](const Piece& p) { return byDimmed ? p.dimmed : p.even; };
    const Piece* piece = nullptr;
    for (const Piece& p : pieces_) {
        if (!(weightOf(p) > 0)) continue;
        piece = &p;
        if (left < weightOf(p)) break;
        left -= weightOf(p);
    }
    const double length = piece->t1 - piece->t0;
    const double v = std::clamp(left / weightOf(*piece), 0.0, 1.0);
    const double along = byDimmed && extinction > 0
                             ? -std::log1p(v * std::expm1(-extinction * length)) / extinction
                             : v * length;
    const double t = piece->t0 + std::min(along, length);
    // Divided by the bound, which is also a factor of the light.
    const double density = 0.5 / even + 0.5 * std::exp(-extinction * (t - first)) / dimmed;
    const double weight = 1 / (density * piece->bound);
    const Rgb glow = piece->part->value(q.origin + q.direction * t, q.time);
    return EmissionPoint{
        t, Rgb::map([&](int c) { return static_cast<float>(double{glow[c]} * weight); }),
        piece->part->description().group};
}

}  // namespace woodcock::medium
