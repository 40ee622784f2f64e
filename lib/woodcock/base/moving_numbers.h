// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace woodcock {

/// Numbers that change within the shutter, as functions of a path's time u in [0, 1]: straight
/// between times, or a jump.
template <std::size_t N>
class MovingNumbers {
public:
    using Numbers = std::array<double, N>;

    /// Of any change: `at` and `before` are as those of MovingTransform::follow(). Straight pieces
    /// differ from it by at most 1e-4 of each number's whole change. Null where nothing changes by
    /// more than rounding.
    static std::shared_ptr<const MovingNumbers> follow(const std::function<Numbers(double)>& at,
                                                       const std::function<Numbers(double)>& before,
                                                       std::span<const double> breaks);

    Numbers at(double u) const {
        const auto piece = std::upper_bound(pieces_.begin() + 1, pieces_.end(), u,
                                            [](double v, const Piece& p) { return v < p.u0; }) -
                           1;
        return between(piece->from, piece->to,
                       std::clamp((u - piece->u0) / (piece->u1 - piece->u0), 0.0, 1.0));
    }

private:
    struct Piece {
        double u0, u1;
        Numbers from, to;
    };
    static constexpr double error = 1e-4, rounding = 1e-12;
    static constexpr int mostHalvings = 12;

    static Numbers between(const Numbers& a, const Numbers& b, double s) {
        Numbers numbers = a;
        for (std::size_t i = 0; i < N; ++i)
            if (a[i] != b[i]) numbers[i] = a[i] * (1 - s) + b[i] * s;
        return numbers;
    }

    std::vector<Piece> pieces_;  // without gaps
};

template <std::size_t N>
std::shared_ptr<const MovingNumbers<N>> MovingNumbers<N>::follow(
    const std::function<Numbers(double)>& at, const std::function<Numbers(double)>& before,
    std::span<const double> breaks) {
    const Numbers first = at(0);
    Numbers least = first, most = first;
    const auto see = [&](const Numbers& numbers) {
        for (std::size_t i = 0; i < N; ++i) {
            least[i] = std::min(least[i], numbers[i]);
            most[i] = std::max(most[i], numbers[i]);
        }
    };
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
        see(at(breaks[i])), see(at((breaks[i] + breaks[i + 1]) / 2)), see(before(breaks[i + 1]));
    std::array<bool, N> changes;
    for (std::size_t i = 0; i < N; ++i)
        changes[i] =
            most[i] - least[i] > rounding * std::max(std::abs(most[i]), std::abs(least[i]));
    if (std::none_of(changes.begin(), changes.end(), [](bool c) { return c; })) return nullptr;
    const auto without = [&](Numbers numbers) {  // the rounding of those that stay
        for (std::size_t i = 0; i < N; ++i)
            if (!changes[i]) numbers[i] = first[i];
        return numbers;
    };

    MovingNumbers moving;
    const auto cut = [&](const auto& self, const Piece& piece, int halvings) -> void {
        const auto fits = [&](double s) {
            const Numbers there = at(piece.u0 + s * (piece.u1 - piece.u0)),
                          own = between(piece.from, piece.to, s);
            for (std::size_t i = 0; i < N; ++i)
                if (changes[i] && std::abs(there[i] - own[i]) > error * (most[i] - least[i]))
                    return false;
            return true;
        };
        if (halvings == 0 || (fits(0.5) && fits(0.2) && fits(0.7))) {
            moving.pieces_.push_back(piece);
            return;
        }
        const double u = (piece.u0 + piece.u1) / 2;
        const Numbers middle = without(at(u));
        self(self, {piece.u0, u, piece.from, middle}, halvings - 1);
        self(self, {u, piece.u1, middle, piece.to}, halvings - 1);
    };
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
        cut(cut, {breaks[i], breaks[i + 1], without(at(breaks[i])), without(before(breaks[i + 1]))},
            mostHalvings);
    return std::make_shared<const MovingNumbers>(std::move(moving));
}

}  // namespace woodcock
