// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "woodcock/bake/node.h"

namespace woodcock::bake {

/// A node that applies one function to every point and channel. `value` takes a pointer to the
/// values of the inputs, `range` one to their intervals.
template <class Value, class Range>
class Pointwise : public Node {
public:
    Pointwise(int channels, Value value, Range range)
        : channels_(channels), value_(std::move(value)), range_(std::move(range)) {}

    int channels() const override { return channels_; }
    void evaluate(const Points& points, std::span<const Values> inputs,
                  std::span<double* const> out) const override {
        std::vector<double> in(inputs.size());
        for (std::size_t c = 0; c < out.size(); ++c)
            for (std::size_t i = 0; i < points.count; ++i) {
                for (std::size_t k = 0; k < in.size(); ++k) in[k] = inputs[k].channel[c][i];
                out[c][i] = value_(std::span<const double>(in));
            }
    }
    Bounds bound(const Box3d&, std::span<const Bounds> inputs) const override {
        Bounds bounds;
        std::vector<Interval> in(inputs.size());
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t k = 0; k < in.size(); ++k) in[k] = inputs[k][c];
            bounds[c] = range_(std::span<const Interval>(in));
        }
        return bounds;
    }

private:
    int channels_;
    Value value_;
    Range range_;
};

template <class Value, class Range>
std::unique_ptr<const Node> pointwise(int channels, Value value, Range range) {
    return std::make_unique<Pointwise<Value, Range>>(channels, std::move(value), std::move(range));
}

/// A scalar function of the position that changes by at most `slope` per unit of length, such as a
/// signed distance (1).
template <class Value>
class OfPosition : public Node {
public:
    OfPosition(Value value, double slope) : value_(std::move(value)), slope_(slope) {}

    void evaluate(const Points& points, std::span<const Values>,
                  std::span<double* const> out) const override {
        for (std::size_t i = 0; i < points.count; ++i) out[0][i] = value_(points[i]);
    }
    Bounds bound(const Box3d& box, std::span<const Bounds>) const override {
        const Vec3d centre = box.centre();
        // Enlarged for rounding.
        const double reach = slope_ * length(box.size()) * 0.5,
                     slack = 1e-12 * (reach + length(centre));
        const Interval all = Interval::around(value_(centre), reach + slack);
        return {all, all, all};
    }

private:
    Value value_;
    double slope_;
};

template <class Value>
std::unique_ptr<const Node> ofPosition(Value value, double slope = 1) {
    return std::make_unique<OfPosition<Value>>(std::move(value), slope);
}

}  // namespace woodcock::bake
