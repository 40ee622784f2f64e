// SPDX-License-Identifier: Apache-2.0
#include "woodcock/camera/camera_motion.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace woodcock::camera {

namespace {

constexpr std::array members{&Lens::fovY, &Lens::height, &Lens::shiftX, &Lens::shiftY};
constexpr double error = 1e-4;
constexpr int mostHalvings = 12;

Lens between(const Lens& a, const Lens& b, double s) {
    Lens lens = a;
    for (const auto member : members)
        if (a.*member != b.*member) lens.*member = a.*member * (1 - s) + b.*member * s;
    return lens;
}

}  // namespace

std::shared_ptr<const MovingLens> MovingLens::follow(const std::function<Lens(double)>& at,
                                                     const std::function<Lens(double)>& before,
                                                     std::span<const double> breaks) {
    MovingLens moving;
    Lens least = at(0), most = least;
    const auto see = [&](const Lens& lens) {
        for (const auto member : members) {
            least.*member = std::min(least.*member, lens.*member);
            most.*member = std::max(most.*member, lens.*member);
        }
    };
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
        see(at(breaks[i])), see(at((breaks[i] + breaks[i + 1]) / 2)), see(before(breaks[i + 1]));
    if (least == most) return nullptr;
    const auto cut = [&](const auto& self, const Piece& piece, int halvings) -> void {
        const auto fits = [&](double s) {
            const Lens there = at(piece.u0 + s * (piece.u1 - piece.u0)),
                       own = between(piece.from, piece.to, s);
            return std::all_of(members.begin(), members.end(), [&](auto member) {
                return std::abs(there.*member - own.*member) <=
                       error * (most.*member - least.*member);
            });
        };
        if (halvings == 0 || (fits(0.5) && fits(0.2) && fits(0.7))) {
            moving.pieces_.push_back(piece);
            return;
        }
        const double u = (piece.u0 + piece.u1) / 2;
        const Lens middle = at(u);
        self(self, {piece.u0, u, piece.from, middle}, halvings - 1);
        self(self, {u, piece.u1, middle, piece.to}, halvings - 1);
    };
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
        cut(cut, {breaks[i], breaks[i + 1], at(breaks[i]), before(breaks[i + 1])}, mostHalvings);
    return std::make_shared<const MovingLens>(std::move(moving));
}

Lens MovingLens::at(double u) const {
    const auto piece = std::upper_bound(pieces_.begin() + 1, pieces_.end(), u,
                                        [](double v, const Piece& p) { return v < p.u0; }) -
                       1;
    return between(piece->from, piece->to,
                   std::clamp((u - piece->u0) / (piece->u1 - piece->u0), 0.0, 1.0));
}

}  // namespace woodcock::camera
