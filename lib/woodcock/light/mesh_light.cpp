// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/mesh_light.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "woodcock/light/spherical_triangle.h"

namespace woodcock::light {

namespace {

// Triangles of a smaller solid angle are sampled uniformly by area: directions into them would
// differ in their last digits only. Triangles of a larger one fill the hemisphere but for rounding:
// all of its directions are sampled, and a few miss.
constexpr double smallest = 1e-8, largest = 2 * pi - 1e-6;

/// A normal of twice the area's length, on the side that emits.
Vec3d wideNormal(const MeshLight::Triangle& t) {
    return cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
}

/// Whether a point lies in the plane of a triangle, as a point on it does. Otherwise rounding would
/// decide on which side it is, and so whether the triangle lights it.
bool inPlaneOf(const MeshLight::Triangle& t, Vec3d from) {
    const Vec3d normal = wideNormal(t);
    double sum = 0;  // of the terms whose difference is the height
    for (int axis = 0; axis < 3; ++axis)
        sum += std::abs(normal[axis]) * (std::abs(from[axis]) + std::abs(t.corner[0][axis]));
    constexpr double rounding = 0x1p-46;  // of a few transforms
    return !(std::abs(dot(normal, t.corner[0] - from)) > rounding * sum);
}

/// Solid angle of the triangle; 0 from its dark side.
double litSolidAngle(const MeshLight::Triangle& t, const SphericalTriangle& seen) {
    return t.bothSides || seen.front() ? seen.solidAngle() : 0;
}

/// The density of sampleDirection(), per steradian. `distance` is that of the point on the
/// triangle.
double density(const MeshLight::Triangle& t, Vec3d from, double solidAngle, double distance) {
    if (solidAngle > largest) return 1 / (2 * pi);
    if (solidAngle >= smallest) return 1 / solidAngle;
    const double height = std::abs(dot(wideNormal(t), t.corner[0] - from));
    return 2 * distance * distance * distance / height;  // distance^2 / (area cosine)
}

/// Sets `distance` to that of the point on the triangle, or to a number that is not positive where
/// the direction misses it.
Vec3d sampleDirection(const MeshLight::Triangle& t, const SphericalTriangle& seen, Vec3d from,
                      double u0, double u1, double& distance) {
    if (seen.solidAngle() < smallest) {
        const double root = std::sqrt(u0);
        const Vec3d d = (t.corner[0] - from) + (t.corner[1] - t.corner[0]) * (root * (1 - u1)) +
                        (t.corner[2] - t.corner[0]) * (root * u1);
        distance = length(d);
        return d / distance;
    }
    const Vec3d normal = wideNormal(t);
    const double height = dot(normal, t.corner[0] - from);
    Vec3d direction;
    if (seen.solidAngle() <= largest) {
        direction = seen.sample(u0, u1);
    } else {
        const double up = 1 - u0, out = std::sqrt(u0 * (2 - u0)), phi = 2 * pi * u1;
        const Vec3d axis = normalize(height > 0 ? normal : -normal);
        Vec3d x, y;
        orthonormalBasis(axis, x, y);
        direction = normalize(x * (out * std::cos(phi)) + y * (out * std::sin(phi)) + axis * up);
        if (!seen.contains(direction)) {
            distance = 0;
            return direction;
        }
    }
    distance = height / dot(normal, direction);
    return direction;
}

EmitterBounds boundsOf(const MeshLight::Triangle& t) {
    EmitterBounds bounds;
    for (const Vec3d& corner : t.corner) bounds.box.add(corner);
    const Vec3d normal = wideNormal(t);
    const double power = t.radiance.mean() * length(normal) / 2;
    if (!(power > 0 && std::isfinite(power))) return bounds;
    bounds.axis = normalize(normal);
    bounds.spread = t.bothSides ? pi : 0;
    bounds.power = power;
    return bounds;
}

MeshLight::Triangle movedBy(const Affine3d& map, MeshLight::Triangle t) {
    for (Vec3d& corner : t.corner) corner = map.point(corner);
    return t;
}

/// Of all that it is while it moves.
EmitterBounds boundsOf(const MeshLight::Triangle& t, const MovingTransform& motion) {
    const EmitterBounds rest = boundsOf(t);
    if (!(rest.power > 0)) return rest;
    EmitterBounds bounds = boundsOf(movedBy(motion.at(0), t));
    bounds.box = motion.box(rest.box);
    bounds.spread = std::min(pi, bounds.spread + motion.largestTurn().value_or(pi));
    bounds.power = rest.power;
    return bounds;
}

}  // namespace

/// The triangles as they are at a time, from a point.
class MeshLight::Moment {
public:
    Moment(const MeshLight& light, Vec3d point, float time)
        : from(point), light_(light), time_(time) {}

    const Vec3d from;
    /// Until the next one is asked for.
    const Triangle& triangle(std::uint32_t index) {
        const Triangle& atRest = light_.triangles_[index];
        if (!light_.moves()) return atRest;
        const MovingTransform* motion = light_.motionOf(index);
        if (!motion) return atRest;
        if (motion != known_) known_ = motion, there_ = motion->at(double{time_});
        return moved_.emplace(movedBy(*there_, atRest));
    }

private:
    const MeshLight& light_;
    float time_;
    const MovingTransform* known_ = nullptr;
    std::optional<Affine3d> there_;
    std::optional<Triangle> moved_;
};

MeshLight::MeshLight(std::vector<Triangle> triangles, RadianceAt radianceAt,
                     std::vector<Moving> moving)
    : triangles_(std::move(triangles)),
      radianceAt_(std::move(radianceAt)),
      moving_(std::move(moving)) {
    addPower();
    std::vector<EmitterBounds> bounds(triangles_.size());
    tbb::parallel_for(std::size_t{0}, triangles_.size(), [&](std::size_t i) {
        const MovingTransform* motion = motionOf(static_cast<std::uint32_t>(i));
        bounds[i] = motion ? boundsOf(triangles_[i], *motion) : boundsOf(triangles_[i]);
    });
    tree_ = LightTree(bounds);
}

const MovingTransform* MeshLight::motionOf(std::uint32_t triangle) const {
    const auto after = std::upper_bound(moving_.begin(), moving_.end(), triangle,
                                        [](std::uint32_t t, const Moving& m) { return t < m.end; });
    return after != moving_.end() && after->first <= triangle ? after->motion.get() : nullptr;
}

void MeshLight::addPower() {
    std::array<double, 3> power{};
    double weights = 0;
    for (const Triangle& t : triangles_) {
        const EmitterBounds b = boundsOf(t);
        if (!(b.power > 0)) continue;
        const double area = length(wideNormal(t)) / 2, sides = t.bothSides ? 2 : 1;
        for (int i = 0; i < 3; ++i)
            power[static_cast<std::size_t>(i)] += double{t.radiance[i]} * area * sides * pi;
        weights += b.power;
        centre_ += (t.corner[0] + t.corner[1] + t.corner[2]) * (b.power / 3);
    }
    if (weights > 0) centre_ = centre_ / weights;
    power_ = *std::max_element(power.begin(), power.end());
}

double MeshLight::importance(std::uint32_t node, Moment& moment) const {
    const LightTree::Node& n = tree_.nodes[node];
    if (!n.leaf()) return n.importance(moment.from);
    const Triangle& t = moment.triangle(n.emitter);
    if (inPlaneOf(t, moment.from)) return 0;
    return t.radiance.mean() * litSolidAngle(t, SphericalTriangle(t.corner, moment.from));
}

/// The probability of a node's first child. NaN where neither child can be seen.
double MeshLight::firstShare(std::uint32_t node, Moment& moment) const {
    const double first = importance(node + 1, moment);
    const double second = importance(tree_.nodes[node].second, moment);
    return first / (first + second);
}

Rgb MeshLight::radianceAt(std::uint32_t index, const Triangle& t, Vec3d position,
                          bool front) const {
    if (!radianceAt_) return t.radiance;
    const Vec3d normal = wideNormal(t), d = position - t.corner[0];
    const double square = dot(normal, normal);
    const double b1 = dot(cross(d, t.corner[2] - t.corner[0]), normal) / square;
    const double b2 = dot(cross(t.corner[1] - t.corner[0], d), normal) / square;
    return radianceAt_(index, b1, b2, front);
}

LightSample MeshLight::sample(Vec3d from, double u0, double u1, float time) const {
    LightSample s;
    if (tree_.nodes.empty()) return s;
    Moment moment(*this, from, time);
    std::uint32_t node = 0;
    double picked = 1;
    while (!tree_.nodes[node].leaf()) {
        const double share = firstShare(node, moment);
        if (std::isnan(share)) return s;
        const bool first = u0 < share;
        u0 = first ? u0 / share : (u0 - share) / (1 - share);
        u0 = std::min(u0, 1 - std::numeric_limits<double>::epsilon() / 2);
        picked *= first ? share : 1 - share;
        node = first ? node + 1 : tree_.nodes[node].second;
    }
    const std::uint32_t triangle = tree_.nodes[node].emitter;
    const Triangle& t = moment.triangle(triangle);
    if (inPlaneOf(t, from)) return s;
    const SphericalTriangle seen(t.corner, from);
    const double solidAngle = litSolidAngle(t, seen);
    if (!(solidAngle > 0)) return s;
    double distance = 0;
    s.direction = sampleDirection(t, seen, from, u0, u1, distance);
    if (!(distance > 0 && std::isfinite(distance))) return s;
    s.distance = distance;
    s.emitter = triangle;
    s.pdf = picked * density(t, from, solidAngle, distance);
    s.weight = radianceAt(triangle, t, from + s.direction * distance, seen.front()) *
               static_cast<float>(1 / s.pdf);
    return s;
}

double MeshLight::pdf(Vec3d from, std::uint32_t triangle, Vec3d position, float time) const {
    Moment moment(*this, from, time);
    double ownDensity = 0;
    {
        const Triangle& t = moment.triangle(triangle);
        if (inPlaneOf(t, from)) return 0;
        const double solidAngle = litSolidAngle(t, SphericalTriangle(t.corner, from));
        if (!(solidAngle > 0) || !(boundsOf(triangles_[triangle]).power > 0)) return 0;
        ownDensity = density(t, from, solidAngle, length(position - from));
    }
    double picked = 1;
    std::uint64_t path = tree_.paths[triangle];
    for (std::uint32_t node = 0; !tree_.nodes[node].leaf(); path >>= 1) {
        const double share = firstShare(node, moment);
        const bool first = (path & 1) == 0;
        picked *= first ? share : 1 - share;
        node = first ? node + 1 : tree_.nodes[node].second;
    }
    return picked * ownDensity;
}

double MeshLight::facingIrradiance(Vec3d from, float time) const {
    Moment moment(*this, from, time);
    return tree_.nodes.empty() ? 0 : importance(0, moment);
}

double MeshLight::importance(const ScatterPoint& at) const {
    const Vec3d d = centre_ - at.position;
    const double distance = length(d);
    const double p = distance > 0 ? at.phaseTowards(d / distance) : 0;
    return facingIrradiance(at.position, at.time) * (0.5 * p + 0.5 / (4 * pi));
}

}  // namespace woodcock::light
