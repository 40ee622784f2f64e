// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/support/plain_medium.h"

#include <algorithm>

#include "woodcock/base/random.h"
#include "woodcock/proof/support/statistics.h"

namespace woodcock::proof {

namespace {

double valueAt(const PlainGrid& grid, const Affine3d& worldFromIndex, Vec3d world, int channel) {
    return grid.trilinear(worldFromIndex.inverse().point(world),
                          grid.channels() == 1 ? 0 : channel);
}

double density(const PlainPart& part, Vec3d world, int channel) {
    if (part.grid) return valueAt(*part.grid, part.worldFromIndex, world, channel);
    return part.box.contains(part.worldFromIndex.inverse().point(world)) ? 1 : 0;
}

/// Integral of a smooth function of three channels.
template <class F>
Vec3d gauss(double a, double b, int n, F&& f) {
    static const oracle::Quadrature rules[] = {oracle::gaussLegendre(3), oracle::gaussLegendre(6)};
    const oracle::Quadrature& rule = rules[n == 3 ? 0 : 1];
    Vec3d sum;
    for (std::size_t i = 0; i < rule.nodes.size(); ++i)
        sum += f(a + (b - a) * rule.nodes[i]) * (rule.weights[i] * (b - a));
    return sum;
}

}  // namespace

medium::Medium PlainMedium::medium(double majorantScale, int smallestLog2,
                                   grid::Storage storage) const {
    medium::Medium medium;
    for (const PlainPart& p : parts_) {
        medium::MediumPart::Description d;
        if (p.grid) d.field = std::make_shared<grid::Field>(p.grid->field(storage));
        d.box = p.box, d.worldFromIndex = p.worldFromIndex;
        d.absorption = p.absorption, d.scattering = p.scattering,
        d.phase = medium::HenyeyGreenstein(p.g);
        if (p.albedo) d.albedo = std::make_shared<grid::Field>(p.albedo->field(storage));
        d.albedoWorldFromIndex = p.albedoWorldFromIndex;
        d.majorantScale = majorantScale, d.majorantSmallestLog2 = smallestLog2;
        medium.parts.emplace_back(std::move(d));
    }
    return medium;
}

Vec3d PlainMedium::sigmaT(Vec3d world) const {
    Vec3d sum;
    for (const PlainPart& p : parts_)
        for (int c = 0; c < 3; ++c)
            sum[c] += (double{p.absorption[c]} + p.scattering[c]) * density(p, world, c);
    return sum;
}

Vec3d PlainMedium::sigmaS(const PlainPart& part, Vec3d world) const {
    Vec3d s;
    for (int c = 0; c < 3; ++c) {
        s[c] = part.scattering[c] * density(part, world, c);
        if (part.albedo) s[c] *= valueAt(*part.albedo, part.albedoWorldFromIndex, world, c);
    }
    return s;
}

std::vector<double> PlainMedium::planes(Vec3d origin, Vec3d direction, double t0, double t1) const {
    std::vector<double> planes{t0, t1};
    const auto add = [&](const Affine3d& worldFromIndex, int axis, double x) {
        const Affine3d m = worldFromIndex.inverse();
        const double d = m.vector(direction)[axis];
        const double t = (x - m.point(origin)[axis]) / d;
        if (d != 0 && t > t0 && t < t1) planes.push_back(t);
    };
    const auto addLattice = [&](const PlainGrid& grid, const Affine3d& worldFromIndex) {
        const Box3d box = grid.support();
        const Affine3d m = worldFromIndex.inverse();
        const Vec3d a = m.point(origin + direction * t0), b = m.point(origin + direction * t1);
        for (int i = 0; i < 3; ++i)
            for (double x = std::ceil(std::max(std::min(a[i], b[i]), box.lower[i]));
                 x <= std::min(std::max(a[i], b[i]), box.upper[i]); ++x)
                add(worldFromIndex, i, x);
    };
    for (const PlainPart& p : parts_) {
        if (p.grid) addLattice(*p.grid, p.worldFromIndex);
        if (p.albedo) addLattice(*p.albedo, p.albedoWorldFromIndex);
        for (int i = 0; i < 3 && !p.grid; ++i)
            add(p.worldFromIndex, i, p.box.lower[i]), add(p.worldFromIndex, i, p.box.upper[i]);
    }
    std::sort(planes.begin(), planes.end());
    return planes;
}

Vec3d PlainMedium::opticalDepth(Vec3d origin, Vec3d direction, double t0, double t1) const {
    Vec3d sum;
    const std::vector<double> t = planes(origin, direction, t0, t1);
    for (std::size_t i = 0; i + 1 < t.size(); ++i)
        sum += gauss(t[i], t[i + 1], 3, [&](double x) { return sigmaT(origin + direction * x); });
    return sum;
}

Vec3d PlainMedium::transmittance(Vec3d origin, Vec3d direction, double t1) const {
    const Vec3d depth = opticalDepth(origin, direction, 0, t1);
    return {std::exp(-depth.x), std::exp(-depth.y), std::exp(-depth.z)};
}

Vec3d PlainMedium::scattered(const PlainPart& part, Vec3d origin, Vec3d direction,
                             double t1) const {
    Vec3d sum, before;
    const auto at = [&](double x) { return sigmaT(origin + direction * x); };
    const std::vector<double> t = planes(origin, direction, 0, t1);
    for (std::size_t i = 0; i + 1 < t.size(); ++i) {
        sum += gauss(t[i], t[i + 1], 6, [&](double x) {
            const Vec3d depth = before + gauss(t[i], x, 3, at);
            return sigmaS(part, origin + direction * x) *
                   Vec3d{std::exp(-depth.x), std::exp(-depth.y), std::exp(-depth.z)};
        });
        before += gauss(t[i], t[i + 1], 3, at);
    }
    return sum;
}

std::vector<TestRay> testRays(const medium::Medium& medium, int count, std::uint64_t seed) {
    RandomStream random(seed);
    const Affine3d& world = medium.parts[0].description().worldFromIndex;
    const Box3d& box = medium.parts[0].support();
    const auto any = [&](double size) {
        return Vec3d{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5} * size;
    };
    std::vector<TestRay> rays;
    for (int i = 0; i < count; ++i) {
        Vec3d through = any(12), step = normalize(any(1)), from = through - step * 40;
        if (i % 5 == 1) from = through;  // from inside
        if (i % 5 == 2) {                // along an axis, in a plane of voxels
            step = {}, step[i % 3] = i % 2 ? 1 : -1;
            through = floorToInt(through).as<double>();
            from = through - step * 30;
        }
        if (i % 5 == 3) {  // along the bounds, just inside
            through = {0.5 * (any(10).x), box.upper.y - 0.01, any(10).z};
            step = normalize(Vec3d{1, 1e-4, random.uniform()});
            from = through - step * 20;
        }
        const double length = i % 5 == 4 ? 42 : 90;  // 42: ends inside
        const Vec3d a = world.point(from), b = world.point(from + step * length);
        rays.push_back({a, normalize(b - a), woodcock::length(b - a)});
    }
    return rays;
}

}  // namespace woodcock::proof
