// SPDX-License-Identifier: Apache-2.0
#include "woodcock/mesh/faceted_mesh.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "woodcock/base/error.h"

namespace woodcock::mesh {
namespace {

struct Plane {
    Vec3d normal;
    double distance;
    double above(Vec3d p) const { return dot(normal, p) - distance; }
};
using Polygon = std::vector<Vec3d>;

/// Where the plane cuts an edge: the same bits from either of its ends.
Vec3d cut(const Plane& plane, Vec3d a, Vec3d b) {
    if (std::tie(b.x, b.y, b.z) < std::tie(a.x, a.y, a.z)) std::swap(a, b);
    const double u = plane.above(a), v = plane.above(b);
    return a + (b - a) * (u / (u - v));
}

/// The convex polygons around a body, from which planes cut pieces off.
class Body {
public:
    explicit Body(double size) : near_(size * 1e-9) {
        for (int axis = 0; axis < 3; ++axis)
            for (const double sign : {-1.0, 1.0}) {
                Vec3d n, s, t;
                n[axis] = sign;
                orthonormalBasis(n, s, t);
                add({(n - s - t) * size, (n + s - t) * size, (n + s + t) * size,
                     (n - s + t) * size});
            }
    }

    void cutBy(const Plane& plane) {
        Polygon rim;
        std::size_t left = 0;
        for (std::size_t i = 0; i < faces_.size(); ++i) {
            // Most faces are far from the plane, on its inner side: they stay as they are.
            if (!(plane.above(balls_[i].centre) + balls_[i].radius < -near_)) {
                if (!cutFace(faces_[i], plane, rim)) continue;
                balls_[i] = ballAround(faces_[i]);
            }
            if (left != i) faces_[left] = std::move(faces_[i]), balls_[left] = balls_[i];
            ++left;
        }
        faces_.resize(left), balls_.resize(left);
        if (Polygon face = ordered(rim, plane.normal); face.size() > 2) add(std::move(face));
    }

    const std::vector<Polygon>& faces() const { return faces_; }

private:
    struct Ball {
        Vec3d centre;
        double radius;
    };
    static Ball ballAround(const Polygon& face) {
        Ball ball{{}, 0};
        for (const Vec3d p : face) ball.centre += p * (1 / static_cast<double>(face.size()));
        for (const Vec3d p : face) ball.radius = std::max(ball.radius, length(p - ball.centre));
        ball.radius *= 1 + 1e-12;
        return ball;
    }

    void add(Polygon face) {
        balls_.push_back(ballAround(face));
        faces_.push_back(std::move(face));
    }

    /// Keeps the part of a face below the plane, and adds its points in the plane to the rim.
    /// False: nothing is left.
    bool cutFace(Polygon& face, const Plane& plane, Polygon& rim) const {
        Polygon kept;
        for (std::size_t i = 0; i < face.size(); ++i) {
            const Vec3d a = face[i], b = face[(i + 1) % face.size()];
            const double u = plane.above(a), v = plane.above(b);
            if (u <= near_) kept.push_back(a);
            if (std::abs(u) <= near_) rim.push_back(a);
            if ((u < -near_ && v > near_) || (u > near_ && v < -near_)) {
                kept.push_back(cut(plane, a, b));
                rim.push_back(kept.back());
            }
        }
        // A face that only touches the plane from above is dropped.
        if (kept.size() < 3 || std::none_of(kept.begin(), kept.end(),
                                            [&](Vec3d p) { return plane.above(p) < -near_; }))
            return false;
        face = std::move(kept);
        return true;
    }

    /// Points of a convex polygon, each once, counter-clockwise about the normal.
    Polygon ordered(const Polygon& points, Vec3d normal) const {
        Polygon distinct;
        Vec3d centre;
        for (const Vec3d p : points)
            if (std::none_of(distinct.begin(), distinct.end(),
                             [&](Vec3d q) { return length(p - q) <= near_; }))
                distinct.push_back(p), centre += p;
        if (distinct.empty()) return {};
        centre = centre / static_cast<double>(distinct.size());
        Vec3d s, t;
        orthonormalBasis(normal, s, t);
        const auto angle = [&](Vec3d p) {
            return std::atan2(dot(p - centre, t), dot(p - centre, s));
        };
        std::sort(distinct.begin(), distinct.end(),
                  [&](Vec3d a, Vec3d b) { return angle(a) < angle(b); });
        return distinct;
    }

    double near_;
    std::vector<Polygon> faces_;
    std::vector<Ball> balls_;  ///< around each face
};

/// The work grows with the square of their number; this many take seconds.
constexpr std::size_t mostFacets = 25'000;

std::vector<Plane> planesOf(std::span<const FacetRing> rings) {
    std::vector<Plane> planes;
    for (const FacetRing& ring : rings) {
        if (!(ring.distance > 0) || !std::isfinite(ring.distance))
            throw usageError("facets at a distance of {}; it must be positive", ring.distance);
        if (!(ring.angle >= 0 && ring.angle <= 180))
            throw usageError("facets at an angle of {}; it must lie between 0 and 180", ring.angle);
        if (ring.count < 1 || ring.count > 1000)
            throw usageError("a ring of {} facets; it must have 1 to 1000", ring.count);
        const double tilt = ring.angle * pi / 180;
        for (int i = 0; i < ring.count; ++i) {
            const double turn = ring.turn * pi / 180 + 2 * pi * i / ring.count;
            planes.push_back(
                {{std::sin(tilt) * std::sin(turn), std::cos(tilt), std::sin(tilt) * std::cos(turn)},
                 ring.distance});
        }
        if (planes.size() > mostFacets)
            throw usageError("more than {} facets; a mesh from a file may have more", mostFacets);
    }
    return planes;
}

}  // namespace

SurfaceMesh facetedMesh(std::span<const FacetRing> rings) {
    const std::vector<Plane> planes = planesOf(rings);
    double size = 1;
    for (const Plane& p : planes) size = std::max(size, p.distance);
    size *= 1e3;
    Body body(size);
    for (const Plane& p : planes) body.cutBy(p);

    TriangleMesh soup;
    for (const Polygon& face : body.faces()) {
        const auto first = static_cast<std::uint32_t>(soup.points.size());
        for (const Vec3d p : face) {
            if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > size / 2)
                throw usageError(
                    "the facets do not enclose a body: it reaches further than {} times their "
                    "distance",
                    500);
            soup.points.push_back(p.as<float>());
        }
        for (std::uint32_t i = 2; i < face.size(); ++i)
            soup.triangles.push_back({first, first + i - 1, first + i});
    }
    if (soup.triangles.empty()) throw usageError("the facets cut away the whole body");
    return {weld(soup), {}, {}};
}

}  // namespace woodcock::mesh
