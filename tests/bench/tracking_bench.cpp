// SPDX-License-Identifier: Apache-2.0
// The pieces of a path, one thread: phase functions, free flights and shadow rays through a cloud.
#include <benchmark/benchmark.h>

#include <limits>
#include <string>

#include "bench_field.h"
#include "woodcock/base/random.h"
#include "woodcock/medium/medium.h"
#include "woodcock/medium/phase.h"
#include "woodcock/medium/tracking.h"

namespace {

using namespace woodcock;
using namespace woodcock::medium;

constexpr int side = 128;

/// A ball whose mean chord has about this optical depth.
Medium ball(double opticalDepth) {
    MediumPart::Description d;
    d.field = std::make_shared<const grid::Field>(bench::wavyBall(side, grid::Storage::Float));
    d.scattering = Rgb(static_cast<float>(opticalDepth / (0.5 * side * 2 / 3)));
    Medium medium;
    medium.parts.emplace_back(d);
    return medium;
}

void phase(benchmark::State& state, const PhaseFunction& phase) {
    RandomStream random(1);
    Vec3d direction{0, 0, 1};
    for (auto _ : state)
        direction = phase.sample(direction, random.uniform(), random.uniform()).direction;
    benchmark::DoNotOptimize(direction);
}

/// A ray from outside through a random place of the middle.
std::pair<Vec3d, Vec3d> ray(RandomStream& random) {
    const auto at = [&] { return side * (0.25 + 0.5 * random.uniform()); };
    const Vec3d to{at(), at(), at()};
    const Vec3d from =
        to + sampleHenyeyGreenstein({0, 0, 1}, 0, random.uniform(), random.uniform()).direction *
                 (2.0 * side);
    return {from, normalize(to - from)};
}

template <int N>
void distance(benchmark::State& state, double opticalDepth) {
    const Medium medium = ball(opticalDepth);
    RandomStream random(1);
    TrackingCounters counters;
    for (auto _ : state) {
        const auto [origin, direction] = ray(random);
        DistanceQuery<N> q{.origin = origin,
                           .direction = direction,
                           .tMax = std::numeric_limits<double>::infinity(),
                           .u = random.uniformOpenLow(),
                           .random = RandomStream(random.bits()),
                           .throughput = Spectrum<N>(1.0f)};
        trackDistance<N>(medium, {&q, 1}, counters);
        benchmark::DoNotOptimize(q.t);
    }
    state.counters["collisions"] =
        static_cast<double>(counters.collisions) / static_cast<double>(state.iterations());
}

template <int N>
void transmittance(benchmark::State& state, double opticalDepth) {
    const Medium medium = ball(opticalDepth);
    RandomStream random(1);
    TrackingCounters counters;
    for (auto _ : state) {
        const auto [origin, direction] = ray(random);
        TransmittanceQuery<N> q{.origin = origin,
                                .direction = direction,
                                .tMax = std::numeric_limits<double>::infinity(),
                                .random = RandomStream(random.bits()),
                                .roulette = 0.05f,
                                .contribution = Spectrum<N>(1.0f)};
        trackTransmittance<N>(medium, {&q, 1}, counters);
        benchmark::DoNotOptimize(q.contribution);
    }
    state.counters["collisions"] =
        static_cast<double>(counters.collisions) / static_cast<double>(state.iterations());
}

}  // namespace

int main(int argc, char** argv) {
    using benchmark::RegisterBenchmark;
    RegisterBenchmark("phase/isotropic", phase, PhaseFunction());
    RegisterBenchmark("phase/forward", phase, PhaseFunction(HenyeyGreenstein(0.9f)));
    RegisterBenchmark("phase/mie", phase, PhaseFunction(MieDroplets(20)));
    for (const double depth : {0.5, 50.0}) {
        const std::string at = "/depth:" + std::to_string(depth).substr(0, 4);
        RegisterBenchmark(("flight/one channel" + at).c_str(), distance<1>, depth);
        RegisterBenchmark(("flight/three channels" + at).c_str(), distance<3>, depth);
        RegisterBenchmark(("shadow ray/one channel" + at).c_str(), transmittance<1>, depth);
        RegisterBenchmark(("shadow ray/three channels" + at).c_str(), transmittance<3>, depth);
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
