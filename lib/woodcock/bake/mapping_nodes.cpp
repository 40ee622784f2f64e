// SPDX-License-Identifier: Apache-2.0
// Nodes that evaluate another node at moved points.
#include <cmath>

#include "woodcock/bake/node_reader.h"
#include "woodcock/base/affine.h"

namespace woodcock::bake {

namespace {

/// Enlarged by the possible rounding.
Box3d padded(Box3d box) {
    for (int i = 0; i < 3; ++i) {
        const double slack = 1e-12 * (std::abs(box.lower[i]) + std::abs(box.upper[i]));
        box.lower[i] -= slack, box.upper[i] += slack;
    }
    return box;
}

/// p + amount x vector(p).
class Warp : public Mapping {
public:
    explicit Warp(Vec3d amount) : amount_(amount) {}

    void move(const Points& points, std::span<const Values> inputs,
              std::span<double* const> out) const override {
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < points.count; ++i)
                out[c][i] =
                    points.at[c][i] + amount_[static_cast<int>(c)] * inputs[0].channel[c][i];
    }
    Box3d moveBox(const Box3d& box, std::span<const Bounds> inputs) const override {
        Box3d moved = box;
        for (int c = 0; c < 3; ++c) {
            const Interval by = inputs[0][static_cast<std::size_t>(c)] * amount_[c];
            moved.lower[c] += by.lower, moved.upper[c] += by.upper;
        }
        return padded(moved);
    }

private:
    Vec3d amount_;
};

/// Transforms a node: scaled, rotated about x, y and z in this order, and moved.
class Placement : public Mapping {
public:
    explicit Placement(const Affine3d& worldFromThing)
        : thingFromWorld_(worldFromThing.inverse()) {}

    void move(const Points& points, std::span<const Values>,
              std::span<double* const> out) const override {
        for (std::size_t i = 0; i < points.count; ++i) {
            const Vec3d p = thingFromWorld_.point(points[i]);
            for (int c = 0; c < 3; ++c) out[static_cast<std::size_t>(c)][i] = p[c];
        }
    }
    Box3d moveBox(const Box3d& box, std::span<const Bounds>) const override {
        return padded(thingFromWorld_.box(box));
    }

private:
    Affine3d thingFromWorld_;
};

Graph::Entry mapping(NodeReader& r, std::unique_ptr<const Mapping> how) {
    Graph::Entry entry{.mapping = std::move(how)};
    entry.mapped = r.mapped("input");
    return entry;
}

Graph::Entry warp(NodeReader& r) {
    const Vec3d amount = r.extent("amount", {}, {});
    r.input("by", 3);
    return mapping(r, std::make_unique<Warp>(amount));
}

Graph::Entry transform(NodeReader& r) {
    const Vec3d turn = r.vector("rotate", {}), scale = r.extent("scale", 1, {});
    if (scale.x * scale.y * scale.z == 0) throw r.table().error("has a scale of zero");
    return mapping(
        r, std::make_unique<Placement>(Affine3d::translate(r.vector("translate", {})) *
                                       Affine3d::rotate(2, turn.z) * Affine3d::rotate(1, turn.y) *
                                       Affine3d::rotate(0, turn.x) * Affine3d::scale(scale)));
}

constexpr NodeType mappingTypes[]{{"warp", warp}, {"transform", transform}};

}  // namespace

std::span<const NodeType> mappingNodes() { return mappingTypes; }

}  // namespace woodcock::bake
