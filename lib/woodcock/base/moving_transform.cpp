// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/moving_transform.h"

#include <algorithm>
#include <cmath>

#include "woodcock/base/error.h"

namespace woodcock {

namespace {

constexpr double wayError = 1e-4, directionError = 1e-5;
constexpr int mostHalvings = 12;

double largestDifference(const Affine3d& a, const Affine3d& b) {
    double difference = 0, size = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        difference = std::max(difference, length(a.column[c] - b.column[c]));
        size = std::max(size, length(a.column[c]));
    }
    return difference / size;
}

double largestLength(const std::array<Vec3d, 3>& m) {
    return std::sqrt(dot(m[0], m[0]) + dot(m[1], m[1]) + dot(m[2], m[2]));
}

}  // namespace

Affine3d MovingTransform::on(const Piece& piece, double s) {
    if (piece.shifts)
        return {piece.start.column, piece.from.translation * (1 - s) + piece.to.translation * s};
    return between(piece.from, piece.to, s).map();
}

std::shared_ptr<const MovingTransform> MovingTransform::follow(
    const std::function<Affine3d(double)>& at, const std::function<Affine3d(double)>& before,
    std::span<const double> breaks, Vec3d centre) {
    const Affine3d toCentre = Affine3d::translate(centre);
    const auto centred = [&](const Affine3d& map) { return map * toCentre; };
    MovingTransform moving;
    moving.centre_ = centre;
    double way = 0;  // roughly, of the centre
    std::vector<std::pair<Affine3d, Affine3d>> ends;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        ends.emplace_back(centred(at(breaks[i])), centred(before(breaks[i + 1])));
        const Affine3d middle = centred(at((breaks[i] + breaks[i + 1]) / 2));
        way += length(middle.translation - ends[i].first.translation) +
               length(ends[i].second.translation - middle.translation);
    }
    const auto pieceOf = [](double u0, double u1, const Affine3d& a, const Affine3d& b) {
        return Piece{u0, u1, a, polarOf(a), polarOf(b), a.column == b.column};
    };
    const auto cut = [&](const auto& self, const Piece& piece, const Affine3d& end,
                         int halvings) -> void {
        const double width = piece.u1 - piece.u0;
        const auto fits = [&](double s) {
            const Affine3d there = centred(at(piece.u0 + s * width)), own = on(piece, s);
            const double rounding =
                1e-13 * (length(there.translation) + length(centre) * largestLength(there.column));
            return length(there.translation - own.translation) <= wayError * way + rounding &&
                   largestDifference(there, own) <= directionError;
        };
        // Not at symmetric places alone: an S passes through its middle.
        if (halvings == 0 || (fits(0.5) && fits(0.2) && fits(0.7))) {
            moving.pieces_.push_back(piece);
            return;
        }
        const double u = piece.u0 + width / 2;
        const Affine3d middle = centred(at(u));
        self(self, pieceOf(piece.u0, u, piece.start, middle), middle, halvings - 1);
        self(self, pieceOf(u, piece.u1, middle, end), end, halvings - 1);
    };
    // By more than rounding: the key of another value may only have cut a straight way.
    const auto differ = [&](const Affine3d& a, const Affine3d& b) {
        constexpr double rounding = 1e-12;
        const double size = length(a.translation) + length(b.translation) + way;
        return length(a.translation - b.translation) > rounding * size ||
               largestDifference(a, b) > rounding;
    };
    bool moves = false;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const auto& [first, last] = ends[i];
        if (first.determinant() * ends[0].first.determinant() < 0)
            throw inputError("a transform mirrors at one time of the shutter, and not at another");
        cut(cut, pieceOf(breaks[i], breaks[i + 1], first, last), last, mostHalvings);
        if (i > 0 && differ(ends[i - 1].second, first)) moving.jumps_ = true;
    }
    for (const Piece& p : moving.pieces_)
        moves |= !p.shifts || !(p.from.translation == p.to.translation);
    if (!moves && !moving.jumps_) return nullptr;
    return std::make_shared<const MovingTransform>(std::move(moving));
}

Affine3d MovingTransform::at(double u) const {
    auto piece = pieces_.begin();
    if (pieces_.size() > 1) {
        piece = std::upper_bound(pieces_.begin() + 1, pieces_.end(), u,
                                 [](double v, const Piece& p) { return v < p.u0; }) -
                1;
    }
    Affine3d map = on(*piece, std::clamp((u - piece->u0) / (piece->u1 - piece->u0), 0.0, 1.0));
    map.translation = map.translation - map.vector(centre_);
    return map;
}

double MovingTransform::speedOf(const Piece& piece, const Box3d& box) {
    double radius = 0;
    for (int corner = 0; corner < 8; ++corner)
        radius = std::max(radius, length(box.corner(corner)));
    std::array<Vec3d, 3> change;
    for (std::size_t c = 0; c < 3; ++c) change[c] = piece.to.stretch[c] - piece.from.stretch[c];
    const double turn = piece.shifts ? 0
                                     : angleBetween(piece.from.rotation, piece.to.rotation) *
                                           std::max(largestLength(piece.from.stretch),
                                                    largestLength(piece.to.stretch)) *
                                           radius;
    const double stretch = piece.shifts ? 0 : largestLength(change) * radius;
    return (length(piece.to.translation - piece.from.translation) + turn + stretch) /
           (piece.u1 - piece.u0);
}

double MovingTransform::largestSpeed(const Box3d& box) const {
    double speed = 0;
    const Box3d relative{box.lower - centre_, box.upper - centre_};
    for (const Piece& piece : pieces_) speed = std::max(speed, speedOf(piece, relative));
    return speed;
}

std::optional<double> MovingTransform::largestTurn() const {
    constexpr double rounding = 1e-12;
    const PolarMap& start = pieces_[0].from;
    const auto stretched = [&](const PolarMap& map) {
        std::array<Vec3d, 3> change;
        for (std::size_t c = 0; c < 3; ++c) change[c] = map.stretch[c] - start.stretch[c];
        return largestLength(change) > rounding * largestLength(start.stretch);
    };
    double turn = 0;
    for (const Piece& piece : pieces_) {
        if (stretched(piece.from) || (!piece.shifts && stretched(piece.to))) return {};
        const double there = angleBetween(start.rotation, piece.from.rotation);
        const double on = piece.shifts ? 0 : angleBetween(piece.from.rotation, piece.to.rotation);
        turn = std::max(turn, there + on);
    }
    return turn;
}

Box3d MovingTransform::box_(const Box3d& box, double u0, double u1) const {
    constexpr int cuts = 64;  // of a whole turn's worth; boxes grow by a 128th of the way between
    const Box3d relative{box.lower - centre_, box.upper - centre_};
    Box3d all;
    if (box.empty()) return all;
    for (const Piece& piece : pieces_) {
        const double from = std::max(u0, piece.u0), to = std::min(u1, piece.u1);
        if (!(from <= to)) continue;
        const double width = piece.u1 - piece.u0;
        const auto add = [&](double u, double margin) {
            const Box3d image = on(piece, (u - piece.u0) / width).box(relative);
            const Vec3d all3 = Vec3d{1, 1, 1} * margin;
            all.add(image.lower - all3), all.add(image.upper + all3);
        };
        if (piece.shifts) {
            add(from, 0), add(to, 0);
            continue;
        }
        const double step = (to - from) / cuts, margin = speedOf(piece, relative) * step / 2;
        for (int i = 0; i <= cuts; ++i) add(i == cuts ? to : from + i * step, margin);
    }
    return all;
}

}  // namespace woodcock
