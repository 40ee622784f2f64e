// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/lattice.h"

#include <algorithm>

#include "woodcock/base/error.h"

namespace woodcock::grid {
namespace {

/// The 512 values of the leaf at `origin`, x slowest; 0 outside of the lattice.
void copyLeafOf(const LatticeValues& lattice, Vec3i origin, std::span<float> leaf) {
    std::fill(leaf.begin(), leaf.end(), 0.0f);
    const Vec3i n = lattice.size;
    const auto end = [&](int axis) { return std::min(8, n[axis] - origin[axis]); };
    for (int x = 0; x < end(0); ++x)
        for (int y = 0; y < end(1); ++y)
            for (int z = 0; z < end(2); ++z) {
                const auto i = static_cast<std::size_t>(origin.x + x),
                           j = std::size_t(origin.y + y), k = std::size_t(origin.z + z);
                leaf[static_cast<std::size_t>(x << 6 | y << 3 | z)] =
                    lattice.values[i + std::size_t(n.x) * (j + std::size_t(n.y) * k)];
            }
}

/// Every voxel that is not background counts as active.
std::array<std::uint64_t, 8> activeVoxels(std::span<const float> leaf) {
    std::array<std::uint64_t, 8> mask{};
    for (std::size_t n = 0; n < leaf.size(); ++n)
        if (leaf[n] != 0) mask[n / 64] |= std::uint64_t{1} << n % 64;
    return mask;
}

}  // namespace

LatticeSource latticeSource(std::shared_ptr<const LatticeValues> lattice) {
    const Vec3i n = lattice->size;
    if (n.x < 1 || n.y < 1 || n.z < 1 ||
        lattice->values.size() != std::size_t(n.x) * std::size_t(n.y) * std::size_t(n.z))
        throw usageError("a volume of {} x {} x {} points needs one value for each, not {} values",
                         n.x, n.y, n.z, lattice->values.size());
    LatticeSource source;
    std::array<float, 512> leaf;
    for (int x = 0; x < n.x; x += 8)
        for (int y = 0; y < n.y; y += 8)
            for (int z = 0; z < n.z; z += 8) {
                const Vec3i origin{x, y, z};
                copyLeafOf(*lattice, origin, leaf);
                const LeafKind kind = scanLeaf(leaf, 1, activeVoxels(leaf), origin,
                                               source.field.background, source.voxels);
                if (kind == LeafKind::Constant)
                    source.field.tiles.push_back({origin, 8, {leaf[0]}});
                if (kind == LeafKind::Varying) source.field.leafOrigins.push_back(origin);
            }
    source.field.copyLeaf = [lattice = std::move(lattice), origins = source.field.leafOrigins](
                                std::size_t i, std::span<float> values) {
        copyLeafOf(*lattice, origins[i], values);
    };
    return source;
}

}  // namespace woodcock::grid
