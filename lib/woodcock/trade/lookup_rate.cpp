// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/lookup_rate.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "woodcock/base/random.h"

namespace woodcock::trade {
grid::Field fieldOfBricks(std::size_t bricks) {
    const int n = std::max(1, static_cast<int>(std::lround(std::cbrt(double(bricks)))));
    grid::FieldSource source;
    for (int i = 0; i < n * n * n; ++i)
        source.leafOrigins.push_back({8 * (i / (n * n)), 8 * (i / n % n), 8 * (i % n)});
    source.copyLeaf = [](std::size_t leaf, std::span<float> values) {
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = static_cast<float>(mixBits(leaf * values.size() + i) >> 40) * 0x1p-24f;
    };
    return grid::buildField(source, grid::Storage::Float);
}

namespace {

/// A loop for each kind. A choice inside one loop would be a conditional move, which waits for both
/// values; then all lookups would be dependent.
template <bool dependent>
double look(const grid::Field& field, std::uint64_t count, std::uint64_t seed) {
    const Box3d& box = field.support();
    const Vec3d size = box.size() * (1 - 1e-6);
    double sum = 0;
    std::uint64_t last = seed;
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t bits = mixBits(last + i);
        constexpr double unit = 0x1p-21;
        const Vec3d p =
            box.lower + Vec3d{size.x * unit * static_cast<double>(bits & 0x1fffff),
                              size.y * unit * static_cast<double>(bits >> 21 & 0x1fffff),
                              size.z * unit * static_cast<double>(bits >> 42 & 0x1fffff)};
        const float value = field.stochastic(p, bits * 0xd6e8feb86659fd93u);
        sum += value;
        if constexpr (dependent) last = seed ^ std::bit_cast<std::uint32_t>(value);
    }
    return sum;
}

}  // namespace

double lookAtRandom(const grid::Field& field, std::uint64_t count, bool dependent,
                    std::uint64_t seed) {
    return dependent ? look<true>(field, count, seed) : look<false>(field, count, seed);
}

}  // namespace woodcock::trade
