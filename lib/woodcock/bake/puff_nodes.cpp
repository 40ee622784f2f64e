// SPDX-License-Identifier: Apache-2.0
// Clusters of spheres that blend into each other.
#include <cmath>

#include "woodcock/bake/node_reader.h"
#include "woodcock/bake/pointwise.h"
#include "woodcock/base/random.h"
#include "woodcock/convert/points_to_density.h"

namespace woodcock::bake {

namespace {

constexpr std::size_t mostPuffs = 20000;

struct Puff {
    Vec3d centre;
    double radius;
};

/// Signed distance to the nearest puff, lowered where others are near: the smooth_min of all puffs.
class Puffs : public Node {
public:
    Puffs(std::vector<Puff> puffs, double width) : puffs_(std::move(puffs)), width_(width) {}

    void evaluate(const Points& points, std::span<const Values>,
                  std::span<double* const> out) const override {
        // Puffs that are too far from the whole box contribute exactly nothing.
        std::vector<Puff> close;
        const double farthest = distanceTo(points.box).upper + width_;
        for (const Puff& puff : puffs_)
            if (distanceTo(puff, points.box).lower <= farthest) close.push_back(puff);
        std::vector<double> distances(close.size());
        for (std::size_t i = 0; i < points.count; ++i) {
            const Vec3d p = points[i];
            double lowest = std::numeric_limits<double>::infinity(), near = 0;
            for (std::size_t k = 0; k < close.size(); ++k) {
                distances[k] = length(p - close[k].centre) - close[k].radius;
                lowest = std::min(lowest, distances[k]);
            }
            for (const double d : distances) {
                const double x = 1 - (d - lowest) / width_;
                if (x > 0) near += x * x * x;
            }
            out[0][i] = lowest - deepest() * (1 - 1 / near);
        }
    }

    Bounds bound(const Box3d& box, std::span<const Bounds>) const override {
        const Interval nearest = distanceTo(box);
        const Interval all{nearest.lower - deepest(), nearest.upper};
        return {all, all, all};
    }

private:
    double deepest() const { return width_ * (2 / 3.0); }

    static Interval distanceTo(const Puff& puff, const Box3d& box) {
        const Vec3d below = box.lower - puff.centre, above = puff.centre - box.upper;
        const Vec3d outside = max(max(below, above), Vec3d{});
        Vec3d far;
        for (int i = 0; i < 3; ++i) far[i] = std::max(-below[i], -above[i]);
        const double slack = 1e-12 * (length(puff.centre) + puff.radius);
        return {length(outside) - puff.radius - slack, length(far) - puff.radius + slack};
    }
    Interval distanceTo(const Box3d& box) const {
        Interval nearest{std::numeric_limits<double>::infinity(),
                         std::numeric_limits<double>::infinity()};
        for (const Puff& puff : puffs_) nearest = min(nearest, distanceTo(puff, box));
        return nearest;
    }

    std::vector<Puff> puffs_;
    double width_;
};

double between(RandomStream& random, std::pair<double, double> ends) {
    return ends.first + (ends.second - ends.first) * random.uniform();
}

/// Uniform in the unit ball, or its flat (y = 0) disc. No sines: the same on every machine.
Vec3d inUnitBall(RandomStream& random, bool flat) {
    for (;;) {
        const double x = 2 * random.uniform() - 1, y = 2 * random.uniform() - 1,
                     z = 2 * random.uniform() - 1;
        const Vec3d p{x, flat ? 0 : y, z};
        if (dot(p, p) <= 1) return p;
    }
}

struct Growth {
    int generations, children;
    std::pair<double, double> shrink;
    double rise;  ///< 0: children on all sides, 1: on the upper side only
};

void grow(const Puff& parent, const Growth& growth, int generation, RandomStream& random,
          std::vector<Puff>& puffs) {
    puffs.push_back(parent);
    if (generation == growth.generations) return;
    for (int i = 0; i < growth.children; ++i) {
        Vec3d side = inUnitBall(random, false);
        while (dot(side, side) < 1e-4) side = inUnitBall(random, false);
        side = normalize(side);
        if (random.uniform() < growth.rise) side.y = std::abs(side.y);
        const Puff child{parent.centre + side * (parent.radius * 0.85),
                         parent.radius * between(random, growth.shrink)};
        grow(child, growth, generation + 1, random, puffs);
    }
}

std::pair<double, double> ends(NodeReader& r, std::string_view key, double a, double b) {
    if (!r.has(key)) return {a, b};
    const auto list = r.list(key, "[from, to]");
    if (list.size() != 2) throw r.table().error("{} must be [from, to]", key);
    return {r.numberOf(list[0], notNegative), r.numberOf(list[1], notNegative)};
}

/// Puffs from which smaller ones grow, generation by generation. The first are scattered over an
/// ellipse in the plane y = 0 (`over = "patch"`: the outer ones smaller by `taper`), in an
/// ellipsoid
/// ("ball"), or along a path ("line") with radii from one end to the other.
Graph::Entry puffs(NodeReader& r) {
    static const std::vector<std::string> arrangements{"patch", "ball", "line"};
    const std::size_t over = r.choice("over", arrangements, 0);
    const int count = r.integer("count", 9, 1, 2000);
    const auto radius = ends(r, "radius", 0.5, 1);
    const Vec3d spread = r.extent("spread", 0, notNegative), centre = r.vector("centre", {});
    const double taper = r.number("taper", 0.5, {0, 1}), sink = r.number("sink", 0, {0, 1});
    const Vec3d from = over == 2 ? r.vector("from") : Vec3d{};
    const Vec3d to = over == 2 ? r.vector("to") : Vec3d{};
    const Growth growth{r.integer("generations", 2, 0, 6), r.integer("children", 5, 1, 20),
                        ends(r, "shrink", 0.4, 0.6), r.number("rise", 1, {0, 1})};
    const double width = r.number("blend", positive);
    double total = 0, generation = count;
    for (int i = 0; i <= growth.generations; ++i, generation *= growth.children)
        total += generation;
    if (total > static_cast<double>(mostPuffs))
        throw r.table().error("makes {} puffs by count, children and generations; at most {}",
                              total, mostPuffs);

    RandomStream random(r.seed());
    std::vector<Puff> all;
    for (int i = 0; i < count; ++i) {
        Puff puff{};
        const Vec3d q = inUnitBall(random, over == 0);
        const Vec3d shift{q.x * spread.x, q.y * spread.y, q.z * spread.z};
        if (over == 2) {
            const double t = (i + random.uniform()) / count;
            puff = {from + (to - from) * t + shift,
                    radius.first + (radius.second - radius.first) * t};
        } else {
            puff.radius = between(random, radius) * (1 - taper * dot(q, q));
            puff.centre = centre + shift + Vec3d{0, sink * puff.radius, 0};
        }
        if (puff.radius > 0) grow(puff, growth, 0, random, all);
    }
    if (all.empty()) throw r.table().error("makes no puffs: all radii are zero");
    return {.node = std::make_unique<Puffs>(std::move(all), width)};
}

/// A puff at each point of a file.
Graph::Entry points(NodeReader& r) {
    const std::filesystem::path file = r.file();
    const convert::PointCloud cloud = convert::readPoints(file);
    const double width = r.number("blend", positive);
    const bool ownRadii = !cloud.radii.empty();
    const double radius = ownRadii ? r.number("radius", 1, positive) : r.number("radius", positive);
    if (cloud.points.size() > mostPuffs)
        throw r.table().error(
            "{} has {} points; this node takes at most {}. `woodcock convert` makes a density of "
            "more",
            file.string(), cloud.points.size(), mostPuffs);
    std::vector<Puff> all;
    for (std::size_t i = 0; i < cloud.points.size(); ++i)
        all.push_back({cloud.points[i], ownRadii ? double(cloud.radii[i]) * radius : radius});
    return {.node = std::make_unique<Puffs>(std::move(all), width)};
}

constexpr NodeType puffTypes[]{{"puffs", puffs}, {"points", points}};

}  // namespace

std::span<const NodeType> puffNodes() { return puffTypes; }

}  // namespace woodcock::bake
