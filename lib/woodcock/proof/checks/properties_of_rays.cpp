// SPDX-License-Identifier: Apache-2.0
// Rays: the intervals of the walk, and the estimators of transmittance.
#include <fmt/format.h>

#include <set>

#include "woodcock/medium/optical_depth.h"
#include "woodcock/medium/tracking.h"
#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/checks/properties.h"
#include "woodcock/proof/checks/volume.h"

namespace woodcock::proof {

namespace {

struct Ray {
    Vec3d origin, direction;  // world; unit
    double tMax;
};

/// A family of rays, in index space: through, from or to a point of the volume's matter.
struct RayKind {
    const char* name;
    std::function<Vec3d(Vec3d, RandomStream&)> point;
    std::function<Vec3d(RandomStream&)> direction;
    double before = 1, after = 1;  // how far the ray reaches, in sizes of the support
};

std::vector<RayKind> rayKinds() {
    const auto there = [](Vec3d p, RandomStream&) { return p; };
    const auto rounded = [](double step) {
        return [step](Vec3d p, RandomStream&) {
            return (p / step + Vec3d{0.5, 0.5, 0.5}).as<int>().as<double>() * step;
        };
    };
    const auto axis = [](RandomStream& random) {
        Vec3d d;
        d[static_cast<int>(random.bits() % 3)] = random.bits() & 1 ? 1 : -1;
        return d;
    };
    const auto nearlyAxis = [axis](RandomStream& random) {
        return axis(random) + anyDirection(random) * 1e-6;
    };
    const auto diagonal = [](RandomStream& random) {
        const auto sign = [&] { return random.bits() & 1 ? 1.0 : -1.0; };
        return Vec3d{sign(), sign(), sign()};
    };
    return {{"through", there, anyDirection},
            {"that start inside", there, anyDirection, 0, 1},
            {"that end inside", there, anyDirection, 1, 0},
            {"along edges of voxels", rounded(1), axis},
            {"nearly along faces of bricks", rounded(8), nearlyAxis},
            {"along edges of bricks", rounded(8), axis},
            {"through corners", rounded(1), diagonal}};
}

/// Along a face of the support, a hundredth of a voxel inside it or outside.
Ray grazing(const Volume& v, RandomStream& random) {
    const Box3d& box = v.field->support();
    Vec3d p, d = anyDirection(random);
    for (int i = 0; i < 3; ++i) p[i] = box.lower[i] + random.uniform() * box.size()[i];
    const int axis = static_cast<int>(random.bits() % 3);
    const double away = random.bits() & 1 ? 0.01 : -0.01;
    p[axis] = random.bits() & 1 ? box.lower[axis] + away : box.upper[axis] + away;
    d[axis] *= 1e-6;
    const double size = length(box.size());
    const Vec3d a = v.worldFromIndex.point(p - normalize(d) * size),
                b = v.worldFromIndex.point(p + normalize(d) * size);
    return {a, normalize(b - a), length(b - a)};
}

Ray rayOf(const Volume& v, const RayKind& kind, RandomStream& random) {
    const std::vector<Vec3d>& matter = v.voxels.matter;
    const Vec3d p = kind.point(matter[random.bits() % matter.size()], random);
    const Vec3d d = normalize(kind.direction(random)) * length(v.field->support().size());
    const Vec3d a = v.worldFromIndex.point(p - d * kind.before),
                b = v.worldFromIndex.point(p + d * kind.after);
    return {a, normalize(b - a), length(b - a)};
}

struct Rays {
    std::string kind;
    std::vector<Ray> rays;
};
std::vector<Rays> raysOf(const Lab& lab, const Volume& v, int count) {
    std::vector<Rays> all;
    RandomStream random(lab.seed("rays, " + v.name));
    for (const RayKind& kind : rayKinds()) {
        all.push_back({kind.name, {}});
        for (int i = 0; i < count; ++i) all.back().rays.push_back(rayOf(v, kind, random));
    }
    all.push_back({"that graze the bounds", {}});
    for (int i = 0; i < count; ++i) all.back().rays.push_back(grazing(v, random));
    return all;
}

// ---- transmittance --------------------------------------------------------------------------

/// One estimate of a ray's transmittance.
using Estimator = std::function<double(const medium::Medium&, const Ray&, std::uint64_t seed)>;

template <int N>
double track(const medium::Medium& medium, const Ray& ray, std::uint64_t seed, float roulette) {
    medium::TransmittanceQuery<N> q{.origin = ray.origin,
                                    .direction = ray.direction,
                                    .tMax = ray.tMax,
                                    .random = RandomStream(seed),
                                    .roulette = roulette,
                                    .contribution = Spectrum<N>(1.0f)};
    medium::TrackingCounters counters;
    medium::trackTransmittance<N>(medium, {&q, 1}, counters);
    return q.contribution[0];
}

double ratioTracking(const medium::Medium& medium, const Ray& ray, std::uint64_t seed) {
    return track<1>(medium, ray, seed, 0);
}

/// As shadow rays do it: at up to four times the rate that is needed, with Russian roulette.
double shadowTracking(const medium::Medium& medium, const Ray& ray, std::uint64_t seed) {
    return track<3>(medium, ray, seed, 0.05f);
}

double escape(const medium::Medium& medium, const Ray& ray, std::uint64_t seed) {
    RandomStream random(seed);
    const double u = random.uniformOpenLow();
    medium::DistanceQuery<1> q{.origin = ray.origin,
                               .direction = ray.direction,
                               .tMax = ray.tMax,
                               .u = u,
                               .random = random,
                               .throughput = Spectrum<1>(1.0f)};
    medium::TrackingCounters counters;
    medium::trackDistance<1>(medium, {&q, 1}, counters);
    return q.part < 0 ? q.throughput[0] : 0;
}

medium::Medium looser(const medium::Medium& medium) {
    medium::MediumPart::Description d = medium.parts[0].description();
    d.majorantScale = 8, d.majorantSmallestLog2 = 3;
    return {{medium::MediumPart(d)}};
}

/// The mean over rays, each estimated equally often. Estimates lie in [0, 1], so with mean T their
/// variance is at most T (1 - T) (Bhatia and Davis 2000). The error follows from that bound: where
/// events are rare, the samples' own variance is unreliable.
void addTransmittance(Lab& lab, const std::string& name, const medium::Medium& medium,
                      const std::vector<Ray>& rays, const std::vector<double>& exact,
                      const Estimator& estimator) {
    const Precision precision{0, lab.pick(1e-2, 1e-3)};
    const auto n = static_cast<double>(rays.size());
    double expected = 0, variance = 0;
    for (const double e : exact) expected += e / n, variance += e * (1 - e) / (n * n);
    const int samples = 16 + static_cast<int>(variance / (precision.floor * precision.floor));
    double mean = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
        for (int k = 0; k < samples; ++k)
            mean += estimator(medium, rays[i], hashOf(lab.seed(name), i, k)) / (n * samples);
    lab.add(caseOf(name, expected, {mean, std::sqrt(variance / samples)}, precision));
}

void transmittance(Lab& lab) {
    for (const Volume& v : volumes(lab, Endless::Too)) {
        const medium::Medium medium{{v.part(Rgb(0.0f), Rgb(1.0f), 0)}}, loose = looser(medium);
        double furthest = 0;
        for (const auto& [kind, rays] : raysOf(lab, v, lab.pick(16, 64))) {
            std::vector<double> exact;
            for (const Ray& r : rays) {
                const double depth = v.opticalDepth(r.origin, r.direction, 0, r.tMax);
                const double ours =
                    medium::exactOpticalDepth(medium, r.origin, r.direction, 0, r.tMax)[0];
                furthest = std::max(furthest, std::abs(ours - depth) / (depth + 1e-3));
                exact.push_back(std::exp(-depth));
            }
            const std::string what = fmt::format("of rays {}, {}", kind, v.name);
            addTransmittance(lab, "transmittance " + what, medium, rays, exact, ratioTracking);
            addTransmittance(lab, "shadows with loose majorants " + what, loose, rays, exact,
                             shadowTracking);
            addTransmittance(lab, "escapes " + what, medium, rays, exact, escape);
            if (lab.full())
                addTransmittance(lab, "escapes with loose majorants " + what, loose, rays, exact,
                                 escape);
        }
        lab.add({.name = "exact optical depth, furthest off in relation, " + v.name,
                 .measured = furthest,
                 .allowance = 2e-6});
    }
}

// ---- intervals ------------------------------------------------------------------------------

struct Violations {
    int rays = 0, segments = 0, cells = 0;
    int gaps = 0, outside = 0, unbounded = 0, missed = 0, loose = 0;
};

/// Up to the rounding of f and of the position.
bool bounds(grid::Range r, const oracle::VoxelFunction& voxel, Vec3d at) {
    const double f = oracle::trilinear(voxel, at);
    double largest = 0;
    for (int corner = 0; corner < 8; ++corner)
        largest = std::max(largest,
                           voxel(floorToInt(at) + Vec3i{corner & 1, corner >> 1 & 1, corner >> 2}));
    const double slack = 1e-6 * f + 1e-9 * largest;
    return r.min <= f + slack && f - slack <= r.max;
}

void walkAlong(const Volume& v, const medium::MediumPart& part, const Ray& ray,
               RandomStream& random, Violations& found) {
    const grid::IndexRay index = part.indexRay(ray.origin, ray.direction);
    const auto f = [&](double t) { return oracle::trilinear(v.voxels.at, index.at(t)); };
    const double slack = 1e-9 * ray.tMax;
    ++found.rays;
    medium::PartWalk walk(part, index, ray.tMax);
    double first = ray.tMax, end = ray.tMax;
    for (grid::Segment s; walk.next(s); end = s.t1, ++found.segments) {
        if (first == ray.tMax && end == ray.tMax)
            first = s.t0;
        else if (std::abs(s.t0 - end) > slack || s.t0 < end)
            ++found.gaps;
        if (!(s.t0 >= 0 && s.t1 >= s.t0 && s.t1 <= ray.tMax)) ++found.outside;
        for (int k = 0; k < 3; ++k)
            found.unbounded +=
                !bounds(s.range, v.voxels.at, index.at(s.t0 + (s.t1 - s.t0) * random.uniform()));
    }
    for (int k = 0; k < 20; ++k) {  // nothing but background where no segment is
        const double t = ray.tMax * random.uniform();
        if ((t < first - slack || t > end + slack) && f(t) > 0) ++found.missed;
    }
}

/// A cell's bounds hold for all voxels that interpolation in it touches, and each bound is one of
/// them to the 2^-7 that storage rounds outwards.
void inspectCell(const Volume& v, const grid::MajorantGrid::Cell& cell, Vec3i corner,
                 Violations& found) {
    ++found.cells;
    const int size = 1 << cell.log2Size;
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (int i = 0; i < (size + 1) * (size + 1) * (size + 1); ++i) {
        const Vec3i at{i % (size + 1), i / (size + 1) % (size + 1), i / (size + 1) / (size + 1)};
        const double f = v.voxels.at(corner + at);
        least = std::min(least, f), most = std::max(most, f);
    }
    constexpr double storage = 0x1p-7, rounding = 1e-6;
    const grid::Range r = cell.range;
    found.unbounded += r.min > least * (1 + rounding) || r.max < most * (1 - rounding);
    found.loose += r.min < least * (1 - storage) || r.max > most * (1 + storage);
}

void intervals(Lab& lab) {
    const int largestCell = lab.pick(4, 6), mostCells = lab.pick(400, 4000);
    for (const Volume& v : volumes(lab, Endless::Too)) {
        const medium::MediumPart part = v.part(Rgb(0.0f), Rgb(1.0f), 0);
        Violations found;
        std::set<std::array<int, 3>> seen;
        RandomStream random(lab.seed("walk, " + v.name));
        for (const auto& [kind, rays] : raysOf(lab, v, lab.pick(24, 400)))
            for (const Ray& ray : rays) {
                walkAlong(v, part, ray, random, found);
                if (found.cells >= mostCells) continue;
                const Vec3d p =
                    part.indexRay(ray.origin, ray.direction).at(ray.tMax * random.uniform());
                const Vec3i voxel = floorToInt(v.field->nearSupport(p));
                const grid::MajorantGrid::Cell cell = part.majorants().find(voxel);
                const int size = 1 << cell.log2Size;
                const Vec3i corner{voxel.x & -size, voxel.y & -size, voxel.z & -size};
                if (cell.log2Size <= largestCell &&
                    seen.insert({corner.x, corner.y, corner.z}).second)
                    inspectCell(v, cell, corner, found);
            }
        const auto add = [&](const std::string& what, int of, const char* where, int violations) {
            lab.add({.name = fmt::format("{}, {}", what, v.name),
                     .measured = double(violations),
                     .note = fmt::format("of {} {}", of, where)});
        };
        add("segments that leave a gap", found.segments, "segments", found.gaps);
        add("segments that leave the ray", found.segments, "segments", found.outside);
        add("values beyond their bounds", found.segments * 3 + found.cells, "places",
            found.unbounded);
        add("values that no segment holds", found.rays * 20, "places", found.missed);
        add("bounds that no voxel attains", found.cells, "cells", found.loose);
    }
}

}  // namespace

std::vector<Check> propertiesOfRays() {
    return {{Kind::Property, "intervals of the walk", intervals},
            {Kind::Property, "transmittance of any volume", transmittance}};
}

}  // namespace woodcock::proof
