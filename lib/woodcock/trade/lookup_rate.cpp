// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/lookup_rate.h"

#include <bit>

#include "woodcock/base/random.h"

namespace woodcock {
double lookAtRandom(const Field& field, std::uint64_t count, bool dependent, std::uint64_t seed) {
    const Box3d& box = field.support();
    const Vec3d size = box.size() * (1 - 1e-6);
    double sum = 0;
    std::uint64_t last = seed;
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t bits = mixBits((dependent ? last : seed) + i);
        constexpr double unit = 0x1p-21;
        const Vec3d p =
            box.lower + Vec3d{size.x * unit * static_cast<double>(bits & 0x1fffff),
                              size.y * unit * static_cast<double>(bits >> 21 & 0x1fffff),
                              size.z * unit * static_cast<double>(bits >> 42 & 0x1fffff)};
        const float value = field.stochastic(p, bits * 0xd6e8feb86659fd93u);
        sum += value;
        last = seed ^ std::bit_cast<std::uint32_t>(value);
    }
    return sum;
}

}  // namespace woodcock
