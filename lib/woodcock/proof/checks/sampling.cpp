// SPDX-License-Identifier: Apache-2.0
// Directions, distances and numbers follow their stated densities.
//
// Cells of every chi-square test are made by an exact distribution, so that all are equally likely
// wherever that can be had. Where no density is known (flights), the exact optical depth is.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "woodcock/base/random.h"
#include "woodcock/base/sample_sequence.h"
#include "woodcock/base/statistics.h"
#include "woodcock/medium/phase.h"
#include "woodcock/medium/tracking.h"
#include "woodcock/proof/checks/cells.h"
#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/oracles/closed_forms.h"
#include "woodcock/proof/oracles/line_integral.h"
#include "woodcock/proof/support/sky.h"
#include "woodcock/proof/support/statistics.h"
#include "woodcock/proof/support/write_vdb.h"
#include "woodcock/render/equiangular.h"

namespace woodcock::proof {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// ---- the phase function -----------------------------------------------------------------------

/// 2 pi times the integral of the phase function over cosines, in the logarithm of the distance
/// from the peak, which spreads it out.
double phaseOverSphere(double g) {
    const double peak = g >= 0 ? 1 : -1, width = 1e-3 * (1 - std::abs(g)) * (1 - std::abs(g));
    return 2 * pi * integrate(std::log(width), std::log(2 + width), 400, [&](double y) {
               const double distance = std::exp(y) - width;
               return medium::henyeyGreenstein(peak * (1 - distance), g) * std::exp(y);
           });
}

void phaseFunction(Lab& lab) {
    const int n = lab.pick(100000, 1000000);
    const Vec3d forward = normalize(Vec3d{0.3, -0.5, -0.7});
    for (const double g :
         {0.0, 1e-7, -1e-7, 1e-3, -1e-3, 0.5, -0.5, 0.99, -0.99, 0.9999, -0.9999}) {
        const std::string name = fmt::format("g {}", g);
        // Cosines are known to 1e-16, beside a peak as narrow as (1 - |g|)^2.
        const double rounding = 1e-15 / ((1 - std::abs(g)) * (1 - std::abs(g)));
        RandomStream random(lab.seed("phase function, " + name));
        Cells cells(20, 8);
        Moments cosine;
        double worst = 0;
        for (int i = 0; i < n; ++i) {
            const medium::PhaseSample s =
                medium::sampleHenyeyGreenstein(forward, g, random.uniform(), random.uniform());
            const double c = dot(s.direction, forward);
            cells.add(oracle::henyeyGreensteinCdf(c, g), turn(forward, s.direction));
            cosine.add(c);
            worst = std::max(worst, std::abs(medium::henyeyGreenstein(c, g) / s.pdf - 1));
        }
        lab.add(cells.asCase("directions, " + name));
        lab.add(meanCase("mean cosine, " + name, g, cosine, lab.pick(1e-2, 1e-3)));
        lab.add(exactCase("integral over the sphere, " + name, 1, phaseOverSphere(g),
                          1e-10 + rounding));
        lab.add(exactCase("largest difference of sampled and evaluated density, " + name, 0, worst,
                          1e-12 + 3 * rounding));
    }
}

// ---- along rays -------------------------------------------------------------------------------

constexpr Box3i noiseBox{{-16, -8, 0}, {15, 15, 23}};

double noise(Vec3i v) {
    for (int i = 0; i < 3; ++i)
        if (v[i] < noiseBox.lower[i] || v[i] > noiseBox.upper[i]) return 0;
    const double u = RandomStream(hashOf(7, v.x, v.y, v.z)).uniform();
    return u < 0.4 ? 0 : u;
}

/// The transmittance to an event is uniform between that of the whole ray and 1. Optical depths are
/// integrated over voxels, without cells or bounds.
void flights(Lab& lab) {
    const int n = lab.pick(10000, 200000);
    GridSpec grid;
    grid.box = noiseBox, grid.value = noise;
    writeVdb(lab.file("noise.vdb"), {grid});
    const double sigma = 0.25;
    const render::Scene scene = sceneIn(
        lab, fmt::format("[[volume]]\nfile = \"noise.vdb\"\nscale = {}\nalbedo = 0.5\n", sigma) +
                 cameraAbove(1));
    // Voxels survive the file as floats.
    const auto voxel = [](Vec3i v) { return double{static_cast<float>(noise(v))}; };
    struct Ray {
        const char* what;
        Vec3d origin, direction;
    };
    for (const Ray& ray : {Ray{"across", {-40, -21, -13}, {1, 0.52, 0.61}},
                           {"along voxels", {-30, 3, 11}, {1, 0, 0}},
                           {"from inside", {-3.3, 9.1, 12.7}, {0.4, -0.7, 0.5}}})
        for (const double looseness : {1.0, 4.0}) {
            const std::string name =
                fmt::format("flights {}, majorants times {}", ray.what, looseness);
            const Vec3d direction = normalize(ray.direction);
            const auto reach = [&](double t) {  // the chance of it
                return std::exp(-sigma *
                                oracle::lineIntegral(voxel, noiseBox, ray.origin, direction, 0, t));
            };
            const render::Scene loose = withParts(
                scene, [&](medium::MediumPart::Description& d) { d.majorantScale = looseness; });
            RandomStream random(lab.seed(name));
            std::vector<medium::DistanceQuery<1>> queries;
            for (int i = 0; i < n; ++i)
                queries.push_back({.origin = ray.origin,
                                   .direction = direction,
                                   .tMax = infinity,
                                   .u = random.uniformOpenLow(),
                                   .random = RandomStream(random.bits()),
                                   .absorptionToo = true,
                                   .throughput = Spectrum<1>(1.0f)});
            medium::TrackingCounters counters;
            medium::trackDistance<1>(loose.medium, queries, counters);
            const double escape = reach(infinity);
            constexpr int bins = 32;
            std::vector<double> shares(bins + 1, (1 - escape) / bins);
            shares[bins] = escape;
            Cells cells(bins + 1, 1, shares);
            double worst = 0;
            for (const medium::DistanceQuery<1>& q : queries) {
                const double share = q.part < 0 ? 1 : (1 - reach(q.t)) / (1 - escape);
                cells.add(q.part < 0 ? 1 : std::min(share, 1 - 1e-12) * bins / (bins + 1));
                worst = std::max(worst, std::abs(double{q.throughput[0]} - 1));
            }
            lab.add(cells.asCase(name));
            lab.add(exactCase("largest change of weight, " + name, 0, worst, 0, "analog"));
        }
}

void equiangular(Lab& lab) {
    const int n = lab.pick(50000, 1000000);
    const Vec3d axis = normalize(Vec3d{0.3, 0.8, -0.4});
    struct Set {
        const char* name;
        double offset, along, t0, t1;  // of the light; of the ray
    };
    for (const Set& s : {Set{"light beside", 1, 3, 0, 10}, Set{"light close", 1e-3, 3, 0, 10},
                         Set{"light behind", 2, -3, 0, 10}, Set{"light beyond", 0.5, 30, 1, 10},
                         Set{"endless ray", 1, 3, 0, infinity}}) {
        const std::string name = fmt::format("equiangular, {}", s.name);
        Vec3d side, other;
        orthonormalBasis(axis, side, other);
        const Vec3d origin{1, 2, 3};
        const render::Equiangular e(origin, axis, origin + axis * s.along + side * s.offset, s.t0,
                                    s.t1, 1e-9, s.t0);
        const auto angle = [&](double t) { return std::atan((t - s.along) / s.offset); };
        const double start = angle(s.t0), range = angle(s.t1) - start;
        RandomStream random(lab.seed(name));
        Cells cells(50, 1);
        double worst = 0;
        for (int i = 0; i < n; ++i) {
            const double t = e.sample(random.uniform()), d = t - s.along;
            cells.add((angle(t) - start) / range);
            const double expected = s.offset / (range * (s.offset * s.offset + d * d));
            worst = std::max(worst, std::abs(e.pdf(t) / expected - 1));
        }
        lab.add(cells.asCase(name));
        // The light's position is known to 1e-15.
        lab.add(exactCase("largest relative error of the density, " + name, 0, worst,
                          1e-14 + 2e-14 / s.offset));
    }
}

// ---- numbers ----------------------------------------------------------------------------------

void numbers(Lab& lab) {
    const int side = lab.pick(200, 1000);
    const std::uint64_t seed = lab.seed("numbers");
    for (const std::uint32_t sample : {0u, 1u, 1000u})
        for (const std::uint32_t set : {0u, 1u, 5u}) {
            Cells cells[]{{16, 16}, {16, 16}, {16, 16}};
            Moments across, sets;
            for (int y = 0; y < side; ++y)
                for (int x = 0; x < side; ++x) {
                    const auto u = SampleSequence(seed, x, y, sample).draw(set);
                    cells[0].add(u[0], u[1]), cells[1].add(u[2], u[3]), cells[2].add(u[0], u[3]);
                    const auto next = SampleSequence(seed, x + 1, y, sample).draw(set);
                    const auto later = SampleSequence(seed, x, y, sample).draw(set + 1);
                    // Of mean 0 and variance 1 where they are independent.
                    across.add(12 * (u[0] - 0.5) * (next[0] - 0.5));
                    sets.add(12 * (u[0] - 0.5) * (later[0] - 0.5));
                }
            const std::string name = fmt::format("sample {}, set {}", sample, set);
            const double error = lab.pick(1e-2, 2e-3);
            lab.add(cells[0].asCase("dimensions 0 and 1 over pixels, " + name));
            lab.add(cells[1].asCase("dimensions 2 and 3 over pixels, " + name));
            lab.add(cells[2].asCase("dimensions 0 and 3 over pixels, " + name));
            lab.add(meanCase("correlation with the next pixel, " + name, 0, across, error));
            lab.add(meanCase("correlation with the next set, " + name, 0, sets, error));
        }
    RandomStream random(seed);
    Cells pairs(32, 32);
    for (int i = 0; i < side * side; ++i) {
        const double u = random.uniform();
        pairs.add(u, random.uniform());
    }
    lab.add(pairs.asCase("successive random numbers"));
}

}  // namespace

std::vector<Check> sampling() {
    return {{Kind::Sampling, "phase function", phaseFunction},
            {Kind::Sampling, "flight distances", flights},
            {Kind::Sampling, "equiangular points", equiangular},
            {Kind::Sampling, "numbers", numbers}};
}

}  // namespace woodcock::proof
