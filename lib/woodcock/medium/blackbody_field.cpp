// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/blackbody_field.h"

#include "woodcock/medium/blackbody.h"

namespace woodcock {

FieldSource blackbodySource(FieldSource temperatures, double scale, double offset) {
    const auto radiance = [scale, offset, cold = temperatures.background[0]](float value) {
        return value == cold ? Rgb(0.0f) : blackbodyRadiance(scale * double{value} + offset);
    };
    FieldSource glow;
    glow.channels = 3;
    glow.leafOrigins = std::move(temperatures.leafOrigins);
    glow.tiles = std::move(temperatures.tiles);
    for (FieldTile& tile : glow.tiles) tile.value = radiance(tile.value[0]).c;
    glow.copyLeaf = [radiance, copy = std::move(temperatures.copyLeaf)](std::size_t i,
                                                                        std::span<float> values) {
        std::array<float, 512> kelvins;
        copy(i, kelvins);
        for (std::size_t v = 0; v < kelvins.size(); ++v) {
            const Rgb q = radiance(kelvins[v]);
            std::copy(q.c.begin(), q.c.end(), values.begin() + static_cast<std::ptrdiff_t>(3 * v));
        }
    };
    return glow;
}

}  // namespace woodcock
