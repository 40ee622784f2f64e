// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/sample_plan.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace woodcock {

namespace {

/// Bounds of a pixel's share, in means: the pilot may have missed what is rare, and one bright
/// sample may not draw everything to its neighbours.
constexpr double leastShare = 0.125, mostShare = 16;
/// Below this part of the picture's mean, errors count absolutely: relMSE's epsilon is its square.
constexpr double darkness = 0.1;

/// What a scattering costs, its shadow ray and the flight after it, in paths without any: 0.46 and
/// 0.30 microseconds in a cumulus.
constexpr double costOfAnEvent = 1.5;

/// What the pilot found in pixels of one colour, in weighted sums.
struct Light {
    std::array<double, 3> variance{}, square{};  ///< of a sample; of the mean radiance
    double radiance = 0, events = 0, weight = 0;

    void add(const Film::Pixel& p, double w) {
        const auto n = static_cast<double>(p.samples);
        if (n < 2) return;
        for (std::size_t c = 0; c < 3; ++c) {
            const double m = p.radiance[c] / n;
            const double v = std::max(0.0, (p.radianceSquared[c] - n * m * m) / (n - 1));
            radiance += w * m / 3;
            variance[c] += w * v;
            square[c] += w * (m * m - v / n);
        }
        events += w * p.events / n;
        weight += w;
    }
    double brightness() const { return weight > 0 ? radiance / weight : 0; }
    /// Of a sample, in paths without events.
    double cost() const { return 1 + costOfAnEvent * events / weight; }
    /// Variance of a sample relative to radiance, summed over channels. Of squares, not of means:
    /// beside something bright, the little of it that reaches here counts as much on both sides.
    double relativeVariance(double epsilon) const {
        double sum = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const double all = std::max(0.0, square[c]) + epsilon * epsilon * weight;
            if (all > 0) sum += variance[c] / all;
        }
        return sum;
    }
};

/// Of the pixels of the other colour around (x, y), by binomial weights: enough of them that rare
/// bright samples do not rule.
Light around(const Film& film, int x, int y) {
    constexpr int reach = 6;
    constexpr std::array<double, reach + 1> binomial{924, 792, 495, 220, 66, 12, 1};
    const Film::Window crop = film.crop();
    Light light;
    for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx) {
            if ((dx + dy) % 2 == 0) continue;
            const int u = x + dx, v = y + dy;
            if (u < crop.x0 || u >= crop.x1 || v < crop.y0 || v >= crop.y1) continue;
            light.add(film.at(u, v), binomial[static_cast<std::size_t>(std::abs(dx))] *
                                         binomial[static_cast<std::size_t>(std::abs(dy))]);
        }
    return light;
}

}  // namespace

SamplePlan::SamplePlan(const Film& pilot, int samples)
    : pixels_(static_cast<std::size_t>(pilot.crop().width()) *
              static_cast<std::size_t>(pilot.crop().height())),
      pilot_(static_cast<std::uint32_t>(samples)) {
    const Film::Window crop = pilot.crop();
    const auto colour = [](int x, int y) { return static_cast<std::size_t>((x + y) & 1); };
    std::array<Light, 2> all;
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x) all[colour(x, y)].add(pilot.at(x, y), 1);
    std::size_t pixel = 0;
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x, ++pixel) {
            const std::size_t own = colour(x, y);
            const Light light = around(pilot, x, y);
            const double share =
                light.weight > 0
                    ? std::sqrt(light.relativeVariance(darkness * all[1 - own].brightness()) /
                                light.cost())
                    : 0;
            colours_[own].push_back({pixel, share});
        }
    for (std::vector<Place>& places : colours_) {
        double sum = 0;
        for (const Place& p : places) sum += p.share;
        for (Place& p : places) {
            const double relative =
                sum > 0 ? p.share * static_cast<double>(places.size()) / sum : 1;
            p.share = std::clamp(relative, leastShare, mostShare);
        }
    }
}

int SamplePlan::pilotOf(int samples) { return std::clamp(samples / 4, 2, 32); }

std::vector<std::uint32_t> SamplePlan::counts(int mean) const {
    std::vector<std::uint32_t> counts(pixels_, pilot_);
    if (static_cast<std::uint32_t>(mean) <= pilot_)
        return std::vector<std::uint32_t>(pixels_, static_cast<std::uint32_t>(mean));
    for (const std::vector<Place>& places : colours_)
        apportion(places, places.size() * static_cast<std::uint64_t>(mean), counts);
    return counts;
}

/// Webster's apportionment: a pixel gets its share x factor, rounded, and the pilot at least. The
/// factor rises until all are given away, so nobody ever has less of more.
void SamplePlan::apportion(const std::vector<Place>& places, std::uint64_t total,
                           std::vector<std::uint32_t>& counts) const {
    const auto count = [&](const Place& p, double factor) {
        return std::max(pilot_, static_cast<std::uint32_t>(p.share * factor + 0.5));
    };
    const auto sum = [&](double factor) {
        std::uint64_t s = 0;
        for (const Place& p : places) s += count(p, factor);
        return s;
    };
    const double mean = static_cast<double>(total) / static_cast<double>(places.size());
    double low = 0, high = (mean + 1) / leastShare;
    while (true) {  // the least factor that gives away too many, and the one before it
        const double middle = low + (high - low) / 2;
        if (!(low < middle && middle < high)) break;
        (sum(middle) <= total ? low : high) = middle;
    }
    std::uint64_t left = total - sum(low);
    for (const Place& p : places) {
        counts[p.pixel] = count(p, low);
        if (left > 0 && count(p, high) > counts[p.pixel]) ++counts[p.pixel], --left;
    }
}

}  // namespace woodcock
