// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/even_light.h"

#include <cmath>

namespace woodcock::light {

Rgb meanRadiance(const LightSet& lights, int light) {
    if (!lights.traits(light).sampled) return lights.distantRadiance(light, {0, 0, 1}, false);
    constexpr int points = 1024;
    constexpr double golden = 0.61803398874989485;
    Rgb sum;
    for (int i = 0; i < points; ++i) {
        const double z = 1 - (2 * i + 1.0) / points, r = std::sqrt(1 - z * z);
        const double phi = 2 * pi * golden * i;
        sum += lights.distantRadiance(light, {r * std::cos(phi), r * std::sin(phi), z}, false);
    }
    return sum * (1.0f / points);
}

Rgb irradiance(const LightSet& lights, int light) {
    constexpr int side = 8;
    Rgb sum;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j)
            sum += lights.sample(light, {}, (i + 0.5) / side, (j + 0.5) / side).weight;
    return sum * (1.0f / (side * side));
}

bool isEven(const LightSet& lights, int light) {
    if (!lights.traits(light).distant) return false;
    if (!lights.traits(light).sampled) return true;
    constexpr int side = 32;
    constexpr double mostEven = 4;
    // Of points in proportion to the radiance: the mean of its square over that of itself.
    double sum = 0;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const LightSample s = lights.sample(light, {}, (i + 0.5) / side, (j + 0.5) / side);
            sum += double{lights.distantRadiance(light, s.direction, false).mean()};
        }
    return sum / (side * side) < mostEven * double{meanRadiance(lights, light).mean()};
}

}  // namespace woodcock::light
