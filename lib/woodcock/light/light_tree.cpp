// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/light_tree.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>

namespace woodcock::light {

namespace {

double angleBetween(Vec3d a, Vec3d b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

/// cos(max(a - b, 0)) of angles in [0, pi].
double cosOfDifference(double cosA, double cosB) {
    if (cosA >= cosB) return 1;
    return cosA * cosB + std::sqrt(std::max(0.0, (1 - cosA * cosA) * (1 - cosB * cosB)));
}

struct Emitter {
    EmitterBounds bounds;
    std::uint32_t index;
};

class Builder {
public:
    explicit Builder(LightTree& tree) : tree_(tree) {}

    EmitterBounds build(std::span<Emitter> chosen, std::size_t node, int depth,
                        std::uint64_t path) {
        LightTree::Node& n = tree_.nodes[node];
        EmitterBounds bounds;
        if (chosen.size() == 1) {
            bounds = chosen[0].bounds;
            n.emitter = chosen[0].index;
            tree_.paths[n.emitter] = path;
        } else {
            const std::size_t middle = split(chosen, depth);
            const std::size_t second = node + 2 * middle;  // after the 2 middle - 1 of the first
            n.second = static_cast<std::uint32_t>(second);
            EmitterBounds a, b;
            const auto buildFirst = [&] {
                a = build(chosen.first(middle), node + 1, depth + 1, path);
            };
            const auto buildSecond = [&] {
                b = build(chosen.subspan(middle), second, depth + 1,
                          path | std::uint64_t{1} << depth);
            };
            if (chosen.size() > 4096)
                tbb::parallel_invoke(buildFirst, buildSecond);
            else
                buildFirst(), buildSecond();
            bounds = merged(a, b);
        }
        n.centre = bounds.box.centre(), n.radius = length(bounds.box.size()) / 2;
        n.axis = bounds.axis, n.cosSpread = std::cos(bounds.spread), n.power = bounds.power;
        return bounds;
    }

private:
    static constexpr std::size_t bucketCount = 12;
    /// Deeper nodes are halved: with 32 bits of emitters no path is longer than 64.
    static constexpr int freeDepth = 31;

    struct Split {
        double cost = std::numeric_limits<double>::infinity();
        int axis = 0;
        std::size_t bucket = 0;  ///< the last of the first child's
    };

    /// Reorders the emitters and returns how many of them are the first child's.
    static std::size_t split(std::span<Emitter> chosen, int depth) {
        Box3d centres;
        for (const Emitter& e : chosen) centres.add(e.bounds.box.centre());
        const Vec3d size = centres.size();
        const double longest = std::max({size.x, size.y, size.z});
        Split best;
        if (depth < freeDepth)
            for (int axis = 0; axis < 3; ++axis)
                if (size[axis] > 0) {
                    Split s = bestSplit(chosen, centres, axis);
                    s.cost *= longest / size[axis];  // thin boxes cost more than their measure says
                    if (s.cost < best.cost) best = s;
                }
        if (best.cost < std::numeric_limits<double>::infinity()) {
            const auto middle = std::partition(chosen.begin(), chosen.end(), [&](const Emitter& e) {
                return bucketOf(e, centres, best.axis) <= best.bucket;
            });
            return static_cast<std::size_t>(middle - chosen.begin());
        }
        const int axis = size.x == longest ? 0 : size.y == longest ? 1 : 2;
        const std::size_t half = chosen.size() / 2;
        std::nth_element(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(half),
                         chosen.end(), [&](const Emitter& a, const Emitter& b) {
                             return a.bounds.box.centre()[axis] < b.bounds.box.centre()[axis];
                         });
        return half;
    }

    static std::size_t bucketOf(const Emitter& emitter, const Box3d& centres, int axis) {
        const double along =
            (emitter.bounds.box.centre()[axis] - centres.lower[axis]) / centres.size()[axis];
        return std::min(static_cast<std::size_t>(along * bucketCount), bucketCount - 1);
    }

    static Split bestSplit(std::span<const Emitter> chosen, const Box3d& centres, int axis) {
        std::array<EmitterBounds, bucketCount> bucket{};
        for (const Emitter& e : chosen) {
            EmitterBounds& b = bucket[bucketOf(e, centres, axis)];
            b.box.add(e.bounds.box);
            b.axis += e.bounds.axis;
            b.spread = std::max(b.spread, e.bounds.spread);
            b.power += e.bounds.power;
        }
        // Around the sum of the axes, which is cheaper than merging cones one by one
        for (EmitterBounds& b : bucket)
            b.axis = length(b.axis) > 0 ? normalize(b.axis) : Vec3d{1, 0, 0};
        std::array<double, bucketCount> leastCosine;
        leastCosine.fill(1);
        for (const Emitter& e : chosen) {
            const std::size_t i = bucketOf(e, centres, axis);
            leastCosine[i] = std::min(leastCosine[i], dot(bucket[i].axis, e.bounds.axis));
        }
        for (std::size_t i = 0; i < bucketCount; ++i)
            bucket[i].spread =
                std::min(pi, bucket[i].spread + std::acos(std::max(leastCosine[i], -1.0)));

        std::array<double, bucketCount> costBelow{};
        EmitterBounds sum = bucket[0];
        for (std::size_t i = 0; i + 1 < bucketCount; ++i) {
            if (i > 0) sum = merged(sum, bucket[i]);
            costBelow[i] = sum.cost();
        }
        Split best;
        best.axis = axis;
        sum = bucket[bucketCount - 1];
        for (std::size_t i = bucketCount - 1; i-- > 0;) {
            // Neither side is empty: the least and the greatest centre are in the outermost
            // buckets.
            if (const double cost = costBelow[i] + sum.cost(); cost < best.cost)
                best.cost = cost, best.bucket = i;
            sum = merged(sum, bucket[i]);
        }
        return best;
    }

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

EmitterBounds merged(const EmitterBounds& a, const EmitterBounds& b) {
    if (b.spread > a.spread) return merged(b, a);
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
    // Of cosines, far above rounding: an emitter that is seen edge-on keeps a chance.
    constexpr double slack = 1e-6;
    const Vec3d d = from - centre;
    const double distance = length(d);
    // The nearest emitter of the node counts most. The tenth was found by experiment: with radius^2
    // itself, the variance close to a mesh of many triangles is ten times as high.
    const double irradiance = power / std::max(distance * distance, radius * radius / 10);
    if (!(distance > radius)) return irradiance;
    const double sinApparent = radius / distance;
    double cosine = cosOfDifference(dot(axis, d) / distance, cosSpread);
    cosine = cosOfDifference(cosine, std::sqrt(1 - sinApparent * sinApparent));
    return cosine > -slack ? irradiance * std::max(cosine, slack) : 0;
}

LightTree::LightTree(std::span<const EmitterBounds> emitters) : paths(emitters.size()) {
    std::vector<Emitter> chosen;
    for (std::size_t i = 0; i < emitters.size(); ++i)
        if (emitters[i].power > 0) chosen.push_back({emitters[i], static_cast<std::uint32_t>(i)});
    if (chosen.empty()) return;
    nodes.resize(2 * chosen.size() - 1);
    Builder(*this).build(chosen, 0, 0, 0);
}

}  // namespace woodcock::light
