// SPDX-License-Identifier: Apache-2.0
// Random looks at a field, one thread: each storage, fields within the caches and beyond them,
// looks that wait for each other and looks that do not.
#include <benchmark/benchmark.h>

#include "bench_field.h"
#include "woodcock/base/random.h"
#include "woodcock/trade/lookup_rate.h"

namespace {

using namespace woodcock;
using namespace woodcock::grid;
using namespace woodcock::trade;

void oneTap(benchmark::State& state, Storage storage, int side, bool dependent) {
    const Field field = bench::wavyBall(side, storage);
    constexpr std::uint64_t count = 1 << 14;
    std::uint64_t seed = 0;
    for (auto _ : state)
        benchmark::DoNotOptimize(lookAtRandom(field, count, dependent, seed += count));
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(count));
    state.counters["MB"] = static_cast<double>(field.bytes()) / 1e6;
}

/// Fields of all sizes, of bricks of noise: 2 KB each. The larger, the more reads miss the table of
/// pages.
void large(benchmark::State& state, bool dependent) {
    const Field field = fieldOfBricks(static_cast<std::size_t>(state.range(0)));
    constexpr std::uint64_t count = 1 << 14;
    std::uint64_t seed = 0;
    for (auto _ : state)
        benchmark::DoNotOptimize(lookAtRandom(field, count, dependent, seed += count));
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(count));
    state.counters["MB"] = static_cast<double>(field.bytes()) / 1e6;
}

void trilinear(benchmark::State& state, Storage storage, int side) {
    const Field field = bench::wavyBall(side, storage);
    RandomStream random(1);
    const Vec3d size = field.support().size();
    for (auto _ : state) {
        const Vec3d p{size.x * random.uniform(), size.y * random.uniform(),
                      size.z * random.uniform()};
        benchmark::DoNotOptimize(field.trilinear(field.support().lower + p));
    }
    state.SetItemsProcessed(state.iterations());
}

}  // namespace

int main(int argc, char** argv) {
    for (std::size_t s = 0; s < storageNames.size(); ++s) {
        const auto storage = static_cast<Storage>(s);
        if (storage == Storage::Auto) continue;
        for (const int side : {64, 256}) {
            const std::string field = storageNames[s] + "/" + std::to_string(side);
            for (const bool dependent : {false, true})
                benchmark::RegisterBenchmark(
                    ("one tap/" + field + (dependent ? "/dependent" : "/independent")).c_str(),
                    oneTap, storage, side, dependent);
            benchmark::RegisterBenchmark(("trilinear/" + field).c_str(), trilinear, storage, side);
        }
    }
    for (const bool dependent : {false, true})
        benchmark::RegisterBenchmark(dependent ? "large/dependent" : "large/independent", large,
                                     dependent)
            ->RangeMultiplier(8)
            ->Range(1 << 12, 1 << 20);  // 8 MB to 2 GB
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
