// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/light_tree.h"

#include <numeric>

namespace woodcock {

namespace {

double angleBetween(Vec3d a, Vec3d b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

/// cos(max(a - b, 0)) of angles in [0, pi].
double cosOfDifference(double cosA, double cosB) {
    if (cosA >= cosB) return 1;
    return cosA * cosB + std::sqrt(std::max(0.0, (1 - cosA * cosA) * (1 - cosB * cosB)));
}

class Builder {
public:
    Builder(std::span<const EmitterBounds> emitters, LightTree& tree)
        : emitters_(emitters), tree_(tree) {}

    EmitterBounds build(std::span<std::uint32_t> chosen, int depth, std::uint64_t path) {
        const std::size_t node = tree_.nodes.size();
        tree_.nodes.emplace_back();
        EmitterBounds bounds;
        if (chosen.size() == 1) {
            bounds = emitters_[chosen[0]];
            tree_.nodes[node].emitter = chosen[0];
            tree_.paths[chosen[0]] = path;
        } else {
            const std::size_t middle = split(chosen, depth);
            const EmitterBounds first = build(chosen.first(middle), depth + 1, path);
            tree_.nodes[node].second = static_cast<std::uint32_t>(tree_.nodes.size());
            bounds = together(
                first, build(chosen.subspan(middle), depth + 1, path | std::uint64_t{1} << depth));
        }
        LightTree::Node& n = tree_.nodes[node];
        n.centre = bounds.box.centre(), n.radius = length(bounds.box.size()) / 2;
        n.axis = bounds.axis, n.cosSpread = std::cos(bounds.spread), n.power = bounds.power;
        return bounds;
    }

private:
    static constexpr std::size_t bucketCount = 12;
    /// From here on halves: with 32 bits of emitters no path is longer than 64.
    static constexpr int freeDepth = 31;

    Vec3d centre(std::uint32_t emitter) const { return emitters_[emitter].box.centre(); }

    struct Split {
        double cost = std::numeric_limits<double>::infinity();
        int axis = 0;
        std::size_t bucket = 0;  ///< the last of the first child's
    };

    /// Reorders the emitters and returns how many of them are the first child's.
    std::size_t split(std::span<std::uint32_t> chosen, int depth) const {
        Box3d centres;
        for (const std::uint32_t e : chosen) centres.add(centre(e));
        const Vec3d size = centres.size();
        const double longest = std::max({size.x, size.y, size.z});
        Split best;
        if (depth < freeDepth)
            for (int axis = 0; axis < 3; ++axis)
                if (size[axis] > 0) {
                    Split s = bestSplit(chosen, centres, axis);
                    s.cost *= longest / size[axis];  // thin boxes are worse than they seem
                    if (s.cost < best.cost) best = s;
                }
        if (best.cost < std::numeric_limits<double>::infinity()) {
            const auto middle = std::partition(chosen.begin(), chosen.end(), [&](std::uint32_t e) {
                return bucketOf(e, centres, best.axis) <= best.bucket;
            });
            return static_cast<std::size_t>(middle - chosen.begin());
        }
        const int axis = size.x == longest ? 0 : size.y == longest ? 1 : 2;
        const std::size_t half = chosen.size() / 2;
        std::nth_element(
            chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(half), chosen.end(),
            [&](std::uint32_t a, std::uint32_t b) { return centre(a)[axis] < centre(b)[axis]; });
        return half;
    }

    std::size_t bucketOf(std::uint32_t emitter, const Box3d& centres, int axis) const {
        const double along = (centre(emitter)[axis] - centres.lower[axis]) / centres.size()[axis];
        return std::min(static_cast<std::size_t>(along * bucketCount), bucketCount - 1);
    }

    Split bestSplit(std::span<const std::uint32_t> chosen, const Box3d& centres, int axis) const {
        std::array<EmitterBounds, bucketCount> bucket{};
        for (const std::uint32_t e : chosen) {
            EmitterBounds& b = bucket[bucketOf(e, centres, axis)];
            b.box.add(emitters_[e].box);
            b.axis += emitters_[e].axis;
            b.power += emitters_[e].power;
        }
        // Around the sum of the axes, which is cheaper than cone by cone
        for (EmitterBounds& b : bucket)
            b.axis = length(b.axis) > 0 ? normalize(b.axis) : Vec3d{1, 0, 0};
        for (const std::uint32_t e : chosen) {
            EmitterBounds& b = bucket[bucketOf(e, centres, axis)];
            const double angle = std::acos(std::clamp(dot(b.axis, emitters_[e].axis), -1.0, 1.0));
            b.spread = std::min(pi, std::max(b.spread, angle + emitters_[e].spread));
        }

        std::array<double, bucketCount> costBelow{};
        EmitterBounds sum = bucket[0];
        for (std::size_t i = 0; i + 1 < bucketCount; ++i) {
            if (i > 0) sum = together(sum, bucket[i]);
            costBelow[i] = sum.cost();
        }
        Split best;
        best.axis = axis;
        sum = bucket[bucketCount - 1];
        for (std::size_t i = bucketCount - 1; i-- > 0;) {
            // No side is empty: the least and the greatest centre are in the outermost buckets.
            if (const double cost = costBelow[i] + sum.cost(); cost < best.cost)
                best.cost = cost, best.bucket = i;
            sum = together(sum, bucket[i]);
        }
        return best;
    }

    std::span<const EmitterBounds> emitters_;
    LightTree& tree_;
};

}  // namespace

double EmitterBounds::cost() const {
    const Vec3d s = box.size();
    const double area = 2 * (s.x * s.y + s.y * s.z + s.z * s.x);
    const double reach = std::min(spread + pi / 2, pi);  // light leaves up to 90 degrees from it
    const double directions =
        2 * pi * (1 - std::cos(spread)) + pi / 2 *
                                              (2 * (reach - spread) * std::sin(spread) -
                                               std::cos(spread - 2 * reach) + std::cos(spread));
    return power * area * directions;
}

EmitterBounds together(const EmitterBounds& a, const EmitterBounds& b) {
    if (b.spread > a.spread) return together(b, a);
    if (b.box.empty()) return a;
    if (a.box.empty()) return b;
    EmitterBounds sum = a;
    sum.box.add(b.box);
    sum.power += b.power;
    const double apart = angleBetween(a.axis, b.axis);
    if (apart + b.spread <= a.spread) return sum;
    sum.spread = (a.spread + apart + b.spread) / 2;
    const Vec3d across = b.axis - a.axis * dot(a.axis, b.axis);
    if (sum.spread >= pi || !(length(across) > 0)) {
        sum.spread = pi;
        return sum;
    }
    const double turn = sum.spread - a.spread;
    sum.axis = normalize(a.axis * std::cos(turn) + normalize(across) * std::sin(turn));
    return sum;
}

double LightTree::Node::importance(Vec3d from) const {
    // Of cosines, and far above rounding: what is seen edge-on keeps a chance.
    constexpr double slack = 1e-6;
    const Vec3d d = from - centre;
    const double distance = length(d);
    // Among them the nearest counts most. Found by experiment: with radius^2 itself, the variance
    // close to a mesh of many triangles is ten times as high.
    const double irradiance = power / std::max(distance * distance, radius * radius / 10);
    if (!(distance > radius)) return irradiance;
    const double sinApparent = radius / distance;
    double cosine = cosOfDifference(dot(axis, d) / distance, cosSpread);
    cosine = cosOfDifference(cosine, std::sqrt(1 - sinApparent * sinApparent));
    return cosine > -slack ? irradiance * std::max(cosine, slack) : 0;
}

LightTree::LightTree(std::span<const EmitterBounds> emitters) : paths(emitters.size()) {
    std::vector<std::uint32_t> chosen;
    for (std::size_t i = 0; i < emitters.size(); ++i)
        if (emitters[i].power > 0) chosen.push_back(static_cast<std::uint32_t>(i));
    if (chosen.empty()) return;
    nodes.reserve(2 * chosen.size() - 1);
    Builder(emitters, *this).build(chosen, 0, 0);
}

}  // namespace woodcock
