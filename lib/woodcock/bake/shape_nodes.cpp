// SPDX-License-Identifier: Apache-2.0
// Shapes: signed distances to a surface in world units, negative inside.
#include <cmath>

#include "woodcock/bake/node_reader.h"
#include "woodcock/bake/pointwise.h"
#include "woodcock/image/read_image.h"

namespace woodcock::bake {

namespace {

Vec3d absolute(Vec3d v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.z)}; }

Graph::Entry sphere(NodeReader& r) {
    const Vec3d centre = r.vector("centre", {});
    const double radius = r.number("radius", positive);
    return {.node = ofPosition([=](Vec3d p) { return length(p - centre) - radius; })};
}

Graph::Entry box(NodeReader& r) {
    const Vec3d centre = r.vector("centre", {}), half = r.extent("size", {}, positive) * 0.5;
    const double rounding = r.number("rounding", 0, notNegative);
    const Vec3d core = max(half - Vec3d{1, 1, 1} * rounding, Vec3d{});
    return {
        .node = ofPosition([=](Vec3d p) {
            const Vec3d q = absolute(p - centre) - core;
            return length(max(q, Vec3d{})) + std::min(std::max({q.x, q.y, q.z}), 0.0) - rounding;
        })};
}

Graph::Entry capsule(NodeReader& r) {
    const Vec3d from = r.vector("from"), axis = r.vector("to") - from;
    const double radius = r.number("radius", positive), square = dot(axis, axis);
    return {.node = ofPosition([=](Vec3d p) {
                const double t =
                    square > 0 ? std::clamp(dot(p - from, axis) / square, 0.0, 1.0) : 0;
                return length(p - from - axis * t) - radius;
            })};
}

Graph::Entry ring(NodeReader& r) {
    const Vec3d centre = r.vector("centre", {});
    const double radius = r.number("radius", positive), width = r.number("thickness", positive);
    return {.node = ofPosition([=](Vec3d p) {
                const Vec3d d = p - centre;
                const double out = std::sqrt(d.x * d.x + d.z * d.z) - radius;
                return std::sqrt(out * out + d.y * d.y) - width;
            })};
}

/// The half-space behind a plane.
Graph::Entry plane(NodeReader& r) {
    const Vec3d direction = r.vector("normal", {0, 1, 0});
    if (length(direction) == 0) throw r.table().error("has a normal of length zero");
    const Vec3d normal = normalize(direction);
    const double offset = r.number("offset", 0);
    return {.node = ofPosition([=](Vec3d p) { return dot(p, normal) - offset; })};
}

/// Quilez 2011, "Menger fractal": crosses are cut out of a cube, level by level.
Graph::Entry menger(NodeReader& r) {
    const Vec3d centre = r.vector("centre", {});
    const double half = r.number("size", positive) * 0.5;
    const int levels = r.integer("levels", 4, 0, 12);
    return {.node = ofPosition([=](Vec3d p) {
                const Vec3d q = (p - centre) * (1 / half), outside = absolute(q) - Vec3d{1, 1, 1};
                double d = length(max(outside, Vec3d{})) +
                           std::min(std::max({outside.x, outside.y, outside.z}), 0.0);
                double scale = 1;
                for (int level = 0; level < levels; ++level) {
                    Vec3d c;
                    for (int i = 0; i < 3; ++i) {
                        const double v = q[i] * scale * 0.5;
                        c[i] = std::abs(1 - 3 * std::abs((v - std::floor(v)) * 2 - 1));
                    }
                    scale *= 3;
                    const double hole =
                        std::min({std::max(c.x, c.y), std::max(c.y, c.z), std::max(c.z, c.x)});
                    d = std::max(d, (hole - 1) / scale);
                }
                return d * half;
            })};
}

/// The inside below a height field. An image's first channel is the height, over x from left to
/// right and z from top to bottom, bilinear between the pixels' centres and constant beyond them.
Graph::Entry heightField(NodeReader& r) {
    const auto image = std::make_shared<image::Image>(image::readImage(r.file("image")));
    const Vec3d centre = r.vector("centre", {});
    const Vec3d size = r.extent("size", {}, positive);
    const auto at = [image](int x, int y) {
        return double(
            image->at(std::clamp(x, 0, image->width - 1), std::clamp(y, 0, image->height - 1))[0]);
    };
    const Vec3d pixel{size.x / image->width, 1, size.z / image->height};
    double steepest = 0;
    for (int y = 0; y < image->height; ++y)
        for (int x = 0; x < image->width; ++x)
            steepest = std::max(steepest, std::hypot((at(x + 1, y) - at(x, y)) / pixel.x,
                                                     (at(x, y + 1) - at(x, y)) / pixel.z) *
                                              size.y);
    // Divided by the largest slope (of one axis in one cell, of the other in the next), the height
    // difference is a lower bound of the distance.
    const double scale = 1 / std::sqrt(1 + 2 * steepest * steepest);
    return {.node = ofPosition([=](Vec3d p) {
                const double u = (p.x - centre.x + size.x / 2) / pixel.x - 0.5,
                             v = (p.z - centre.z + size.z / 2) / pixel.z - 0.5;
                const double x = std::clamp(u, 0.0, image->width - 1.0),
                             y = std::clamp(v, 0.0, image->height - 1.0);
                const int i = static_cast<int>(x), j = static_cast<int>(y);
                const double s = x - i, t = y - j;
                const double height = (at(i, j) * (1 - s) + at(i + 1, j) * s) * (1 - t) +
                                      (at(i, j + 1) * (1 - s) + at(i + 1, j + 1) * s) * t;
                return (p.y - centre.y - height * size.y) * scale;
            })};
}

/// A coordinate, or the distance to the origin; with `origin` and `per` as units.
Graph::Entry position(NodeReader& r) {
    static const std::vector<std::string> names{"x", "y", "z", "radius", "axis_distance"};
    const std::size_t which = r.choice("of", names, 1);
    const Vec3d origin = r.vector("origin", {});
    return {.node = ofPosition([=](Vec3d p) {
                const Vec3d d = p - origin;
                if (which < 3) return d[static_cast<int>(which)];
                return which == 3 ? length(d) : std::sqrt(d.x * d.x + d.z * d.z);
            })};
}

constexpr NodeType shapeTypes[]{
    {"sphere", sphere}, {"box", box},       {"capsule", capsule},          {"ring", ring},
    {"plane", plane},   {"menger", menger}, {"height_field", heightField}, {"position", position}};

}  // namespace

std::span<const NodeType> shapeNodes() { return shapeTypes; }

}  // namespace woodcock::bake
