// SPDX-License-Identifier: Apache-2.0
// Nodes that combine the values of other nodes at the same point. A scalar among vectors is used
// for each of their channels.
#include <cmath>

#include "woodcock/bake/node_reader.h"
#include "woodcock/bake/pointwise.h"

namespace woodcock::bake {

namespace {

using Numbers = std::span<const double>;
using Intervals = std::span<const Interval>;

/// A fold over a list of inputs, for numbers and for intervals alike.
template <class Combine>
Graph::Entry ofList(NodeReader& r, Combine combine) {
    const int channels = r.inputs("inputs");
    const auto all = [combine](auto in) {
        auto result = in[0];
        for (const auto& v : in.subspan(1)) result = combine(result, v);
        return result;
    };
    return {.node = pointwise(
                channels, [all](Numbers in) { return all(in); },
                [all](Intervals in) { return all(in); })};
}

Graph::Entry add(NodeReader& r) {
    return ofList(r, [](auto a, auto b) { return a + b; });
}
Graph::Entry multiply(NodeReader& r) {
    return ofList(r, [](auto a, auto b) { return a * b; });
}
struct Least {
    double operator()(double a, double b) const { return std::min(a, b); }
    Interval operator()(Interval a, Interval b) const { return min(a, b); }
};
struct Most {
    double operator()(double a, double b) const { return std::max(a, b); }
    Interval operator()(Interval a, Interval b) const { return max(a, b); }
};
Graph::Entry least(NodeReader& r) { return ofList(r, Least()); }
Graph::Entry most(NodeReader& r) { return ofList(r, Most()); }

/// The least input, lowered where others are near it; the order of inputs does not matter. Two
/// surfaces meet in a fillet `width` wide. `sign` -1 makes it the greatest.
Graph::Entry smooth(NodeReader& r, double sign) {
    const double width = r.number("width", positive);
    const int channels = r.inputs("inputs");
    return {.node = pointwise(
                channels,
                [=](Numbers in) {
                    double lowest = sign * in[0], near = 0;
                    for (const double v : in) lowest = std::min(lowest, sign * v);
                    for (const double v : in) {
                        const double x = 1 - std::min((sign * v - lowest) / width, 1.0);
                        near += x * x * x;
                    }
                    return sign * (lowest - width * (2 / 3.0) * (1 - 1 / near));
                },
                [=](Intervals in) {
                    Interval lowest = in[0] * sign;
                    for (const Interval& v : in) lowest = min(lowest, v * sign);
                    const double most =
                        width * (2 / 3.0) * (1 - 1 / static_cast<double>(in.size()));
                    return Interval{lowest.lower - most - 1e-12 * std::abs(lowest.lower),
                                    lowest.upper + 1e-12 * std::abs(lowest.upper)} *
                           sign;
                })};
}
Graph::Entry smoothMin(NodeReader& r) { return smooth(r, 1); }
Graph::Entry smoothMax(NodeReader& r) { return smooth(r, -1); }

int channelsOf(std::initializer_list<int> inputs) { return std::max(inputs); }

Graph::Entry subtract(NodeReader& r) {
    const int a = r.input("a", 0), b = r.input("b", 0);
    return {.node = pointwise(
                channelsOf({a, b}), [](Numbers in) { return in[0] - in[1]; },
                [](Intervals in) { return in[0] - in[1]; })};
}

Graph::Entry mix(NodeReader& r) {
    const int a = r.input("a", 0), b = r.input("b", 0), by = r.input("by", 0);
    return {.node = pointwise(
                channelsOf({a, b, by}),
                [](Numbers in) {
                    const double t = std::clamp(in[2], 0.0, 1.0);
                    return in[0] * (1 - t) + in[1] * t;
                },
                [](Intervals in) {
                    const Interval t = clamp(in[2], 0, 1);
                    return in[0] * (Interval{1, 1} - t) + in[1] * t;
                })};
}

double smoothStep(double t) { return t * t * (3 - 2 * t); }

/// Maps one range of values to another, linearly or with soft ends; clamped outside unless told
/// otherwise.
Graph::Entry remap(NodeReader& r) {
    static const std::vector<std::string> profiles{"linear", "smooth", "extend"};
    const auto ends = [&r](std::string_view key, double a, double b) {
        if (!r.has(key)) return std::pair{a, b};
        const auto list = r.list(key, "[start, end]");
        if (list.size() != 2) throw r.table().error("{} must be [start, end]", key);
        return std::pair{r.numberOf(list[0]), r.numberOf(list[1])};
    };
    const auto [a, b] = ends("from", 0, 1);
    const auto [c, d] = ends("to", 0, 1);
    if (a == b) throw r.table().error("has an empty range, from = [{}, {}]", a, b);
    const std::size_t profile = r.choice("profile", profiles, 0);
    const int channels = r.input("input", 0);
    const auto value = [=, a = a, b = b, c = c, d = d](double v) {
        double t = (v - a) / (b - a);
        if (profile < 2) t = std::clamp(t, 0.0, 1.0);
        if (profile == 1) t = smoothStep(t);
        return c + (d - c) * t;
    };
    return {.node = pointwise(
                channels, [value](Numbers in) { return value(in[0]); },
                [value](Intervals in) {
                    const double x = value(in[0].lower), y = value(in[0].upper);
                    return Interval{std::min(x, y), std::max(x, y)};
                })};
}

/// Density from a signed distance: 0 at the surface, 1 at `edge` inside.
Graph::Entry falloff(NodeReader& r) {
    static const std::vector<std::string> profiles{"smooth", "linear"};
    const double edge = r.number("edge", positive), density = r.number("density", 1);
    const std::size_t profile = r.choice("profile", profiles, 0);
    r.input("input");
    const auto value = [=](double d) {
        const double t = std::clamp(-d / edge, 0.0, 1.0);
        return density * (profile == 0 ? smoothStep(t) : t);
    };
    return {.node = pointwise(
                1, [value](Numbers in) { return value(in[0]); },
                [value](Intervals in) {
                    const double x = value(in[0].lower), y = value(in[0].upper);
                    return Interval{std::min(x, y), std::max(x, y)};
                })};
}

/// Moves a surface outwards by amount x by.
Graph::Entry displace(NodeReader& r) {
    const double amount = r.number("amount");
    r.input("input"), r.input("by");
    return {.node = pointwise(
                1, [=](Numbers in) { return in[0] - amount * in[1]; },
                [=](Intervals in) { return in[0] - in[1] * amount; })};
}

/// Erodes a density where `by` is high: values above amount x by are stretched to [0, 1] (Schneider
/// 2015, "The real-time volumetric cloudscapes of Horizon Zero Dawn").
Graph::Entry erode(NodeReader& r) {
    const double amount = r.number("amount", {0, 0.999});
    r.input("input"), r.input("by");
    const auto value = [=](double density, double by) {
        const double eaten = amount * std::clamp(by, 0.0, 1.0);
        return std::max(density - eaten, 0.0) / (1 - eaten);
    };
    return {.node = pointwise(
                1, [value](Numbers in) { return value(in[0], in[1]); },
                [value](Intervals in) {
                    // Falls with `by` where the density is at most 1, else rises.
                    const double v[]{
                        value(in[0].lower, in[1].lower), value(in[0].lower, in[1].upper),
                        value(in[0].upper, in[1].lower), value(in[0].upper, in[1].upper)};
                    return Interval{*std::min_element(v, v + 4), *std::max_element(v, v + 4)};
                })};
}

/// |v|^exponent with v's sign.
Graph::Entry power(NodeReader& r) {
    const double exponent = r.number("exponent", {0, 100});
    const int channels = r.input("input", 0);
    const auto value = [=](double v) { return std::copysign(std::pow(std::abs(v), exponent), v); };
    return {.node = pointwise(
                channels, [value](Numbers in) { return value(in[0]); },
                [value](Intervals in) {
                    const Interval v = rising(in[0], value);
                    // The library's pow may not be monotonic in its last digit.
                    return Interval{v.lower - 1e-15 * std::abs(v.lower),
                                    v.upper + 1e-15 * std::abs(v.upper)};
                })};
}

Graph::Entry exponential(NodeReader& r) {
    const int channels = r.input("input", 0);
    return {.node = pointwise(
                channels, [](Numbers in) { return std::exp(in[0]); },
                [](Intervals in) {
                    const Interval v = rising(in[0], [](double x) { return std::exp(x); });
                    return Interval{v.lower * (1 - 1e-15), v.upper * (1 + 1e-15)};
                })};
}

Graph::Entry absolute(NodeReader& r) {
    const int channels = r.input("input", 0);
    return {.node = pointwise(
                channels, [](Numbers in) { return std::abs(in[0]); },
                [](Intervals in) { return abs(in[0]); })};
}

/// Nodes that look at several channels at once.
class VectorOf : public Node {
public:
    int channels() const override { return 3; }
    void evaluate(const Points& points, std::span<const Values> inputs,
                  std::span<double* const> out) const override {
        for (std::size_t c = 0; c < 3; ++c) std::copy_n(inputs[c].channel[0], points.count, out[c]);
    }
    Bounds bound(const Box3d&, std::span<const Bounds> inputs) const override {
        return {inputs[0][0], inputs[1][0], inputs[2][0]};
    }
};
Graph::Entry vectorOf(NodeReader& r) {
    for (const char* axis : {"x", "y", "z"}) r.input(axis);
    return {.node = std::make_unique<VectorOf>()};
}

class LengthOf : public Node {
public:
    void evaluate(const Points& points, std::span<const Values> inputs,
                  std::span<double* const> out) const override {
        for (std::size_t i = 0; i < points.count; ++i)
            out[0][i] = woodcock::length(
                Vec3d{inputs[0].channel[0][i], inputs[0].channel[1][i], inputs[0].channel[2][i]});
    }
    Bounds bound(const Box3d&, std::span<const Bounds> inputs) const override {
        Vec3d low, high;
        for (int c = 0; c < 3; ++c) {
            const Interval v = abs(inputs[0][static_cast<std::size_t>(c)]);
            low[c] = v.lower, high[c] = v.upper;
        }
        const Interval all{woodcock::length(low) * (1 - 1e-15),
                           woodcock::length(high) * (1 + 1e-15)};
        return {all, all, all};
    }
};
Graph::Entry length(NodeReader& r) {
    r.input("input", 3);
    return {.node = std::make_unique<LengthOf>()};
}

/// Colours, interpolated linearly between those at given values.
class ColourRamp : public Node {
public:
    struct Stop {
        double at;
        Vec3d colour;
    };
    explicit ColourRamp(std::vector<Stop> stops) : stops_(std::move(stops)) {}

    int channels() const override { return 3; }
    void evaluate(const Points& points, std::span<const Values> inputs,
                  std::span<double* const> out) const override {
        for (std::size_t i = 0; i < points.count; ++i) {
            const Vec3d v = at(inputs[0].channel[0][i]);
            for (int c = 0; c < 3; ++c) out[static_cast<std::size_t>(c)][i] = v[c];
        }
    }
    Bounds bound(const Box3d&, std::span<const Bounds> inputs) const override {
        const Interval in = inputs[0][0];
        Box3d box;
        box.add(at(in.lower)), box.add(at(in.upper));
        for (const Stop& stop : stops_)
            if (in.contains(stop.at)) box.add(stop.colour);
        Bounds bounds;
        for (int c = 0; c < 3; ++c)
            bounds[static_cast<std::size_t>(c)] = {box.lower[c] - 1e-12, box.upper[c] + 1e-12};
        return bounds;
    }

private:
    Vec3d at(double v) const {
        if (!(v > stops_.front().at)) return stops_.front().colour;
        for (std::size_t i = 1; i < stops_.size(); ++i) {
            const Stop &a = stops_[i - 1], &b = stops_[i];
            if (v <= b.at) {
                const double t = (v - a.at) / (b.at - a.at);
                return a.colour * (1 - t) + b.colour * t;
            }
        }
        return stops_.back().colour;
    }

    std::vector<Stop> stops_;
};
Graph::Entry colourRamp(NodeReader& r) {
    std::vector<ColourRamp::Stop> stops;
    constexpr const char* form = "a list of [value, [r, g, b]]";
    for (const TomlValue& stop : r.list("stops", form)) {
        const auto pair = stop.elements("[value, [r, g, b]]", 2);
        stops.push_back({r.numberOf(pair[0]), r.vectorOf(pair[1])});
        if (stops.size() > 1 && !(stops.back().at > stops[stops.size() - 2].at))
            throw stop.error("does not lie above the stop before it");
    }
    if (stops.empty()) throw r.table().error("has no stops");
    r.input("input");
    return {.node = std::make_unique<ColourRamp>(std::move(stops))};
}

constexpr NodeType combinationTypes[]{{"add", add},
                                      {"multiply", multiply},
                                      {"min", least},
                                      {"max", most},
                                      {"smooth_min", smoothMin},
                                      {"smooth_max", smoothMax},
                                      {"subtract", subtract},
                                      {"mix", mix},
                                      {"remap", remap},
                                      {"falloff", falloff},
                                      {"displace", displace},
                                      {"erode", erode},
                                      {"power", power},
                                      {"abs", absolute},
                                      {"exp", exponential},
                                      {"vector", vectorOf},
                                      {"length", length},
                                      {"colour_ramp", colourRamp}};

}  // namespace

std::span<const NodeType> combinationNodes() { return combinationTypes; }

}  // namespace woodcock::bake
