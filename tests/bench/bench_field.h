// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "woodcock/grid/field.h"

namespace woodcock::bench {

/// A ball of waves in [0, 1], `side` voxels wide, a multiple of 8; every leaf that it touches
/// varies.
inline grid::Field wavyBall(int side, grid::Storage storage) {
    grid::FieldSource source;
    const double radius = side / 2.0;
    const auto inside = [=](Vec3d p) { return length(p - Vec3d{radius, radius, radius}) < radius; };
    for (int x = 0; x < side; x += 8)
        for (int y = 0; y < side; y += 8)
            for (int z = 0; z < side; z += 8)
                if (inside({x + 4.0, y + 4.0, z + 4.0})) source.leafOrigins.push_back({x, y, z});
    source.copyLeaf = [&source, side](std::size_t leaf, std::span<float> values) {
        const double k = 40.0 / side;
        for (int i = 0; i < 512; ++i) {
            const Vec3i v = source.leafOrigins[leaf] + Vec3i{i >> 6, i >> 3 & 7, i & 7};
            values[static_cast<std::size_t>(i)] = static_cast<float>(
                0.5 + 0.5 * std::sin(k * v.x) * std::sin(k * v.y) * std::sin(k * v.z));
        }
    };
    return grid::buildField(source, storage);
}

}  // namespace woodcock::bench
