// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/coarsen.h"

#include <unordered_map>
#include <unordered_set>

#include "woodcock/grid/block_ranges.h"

namespace woodcock::grid {

namespace {

/// The coarse leaves and tiles of a field.
class Coarsener {
public:
    Coarsener(const Field& field, const Field* weights) : field_(field), weights_(weights) {
        source_.channels = field.channels();
        for (int c = 0; c < field.channels(); ++c)
            source_.background[static_cast<std::size_t>(c)] = field.background(c);
        if (const auto& limits = field.limits())  // a voxel around the voxels within
            source_.within = Box3i{floorToInt((limits->lower + Vec3d{1, 1, 1}) / 2),
                                   floorToInt((limits->upper - Vec3d{1, 1, 1}) / 2)};
        field.blocks().forEach([&](Vec3i b, int log2Size, std::uint32_t ref) {
            if (ref == field.blocks().outside()) return;
            if (log2Size == blockLog2)
                addBlock({b.x >> 1, b.y >> 1, b.z >> 1});
            else
                addTiles(b * 4, 1 << (log2Size - 1), log2Size == superLog2 ? 128 : 8);
        });
        source_.copyLeaf = [this](std::size_t i, std::span<float> values) { copyLeaf(i, values); };
    }
    const FieldSource& source() const { return source_; }

private:
    void addBlock(Vec3i block) {
        const auto part = [](int v) { return static_cast<std::uint64_t>(v) & 0x1fffffffu; };
        const std::uint64_t high = part(block.x), low = part(block.y) << 32 | part(block.z);
        if (!seen_[high].insert(low).second) return;
        const std::uint32_t first = *field_.blocks().find(block * 2).value;
        bool constant = true;  // each brick is used by one block only
        for (int i = 1; i < 8; ++i)
            constant &= *field_.blocks().find(block * 2 + sideOf(i)).value == first;
        if (constant)
            addTiles(block * 8, 8, 8);
        else
            source_.leafOrigins.push_back(block * 8);
    }

    /// The constant cube from voxel `origin`, `width` voxels wide, in tiles of `size`.
    void addTiles(Vec3i origin, int width, int size) {
        FieldTile tile{origin, size, {}};
        for (int c = 0; c < field_.channels(); ++c)
            tile.value[static_cast<std::size_t>(c)] = field_.voxel(origin * 2, c);
        for (int x = 0; x < width; x += size)
            for (int y = 0; y < width; y += size)
                for (int z = 0; z < width; z += size) {
                    tile.origin = origin + Vec3i{x, y, z};
                    source_.tiles.push_back(tile);
                }
    }

    void copyLeaf(std::size_t leaf, std::span<float> values) const {
        const Vec3i origin = source_.leafOrigins[leaf];
        const Vec3i block{origin.x >> 2, origin.y >> 2, origin.z >> 2};  // the first fine one
        std::size_t at = 0;
        for (int i = 0; i < 512; ++i) {
            const Vec3i v = Vec3i{i >> 6, i >> 3 & 7, i & 7} * 2;
            const Vec3i fine = block + Vec3i{v.x >> 3, v.y >> 3, v.z >> 3};
            std::array<double, 8> share;
            share.fill(1.0 / 8);
            if (weights_) weigh({*weights_, fine}, v, share);
            const Field::BlockVoxels voxels(field_, fine);
            for (int c = 0; c < field_.channels(); ++c) {
                double mean = 0;
                for (int j = 0; j < 8; ++j)
                    mean += share[static_cast<std::size_t>(j)] * double{voxels(v + sideOf(j), c)};
                values[at++] = static_cast<float>(mean);
            }
        }
    }
    static void weigh(const Field::BlockVoxels& weights, Vec3i v, std::array<double, 8>& share) {
        std::array<double, 8> weight;
        double sum = 0;
        for (int j = 0; j < 8; ++j)
            sum += weight[static_cast<std::size_t>(j)] = double{weights(v + sideOf(j))};
        if (!(sum > 0)) return;
        for (std::size_t j = 0; j < 8; ++j) share[j] = weight[j] / sum;
    }

    const Field& field_;
    const Field* weights_;
    FieldSource source_;
    std::unordered_map<std::uint64_t, std::unordered_set<std::uint64_t>> seen_;  // blocks, by x
};

}  // namespace

Field coarsened(const Field& field, const Field* weights) {
    Field coarse = buildField(Coarsener(field, weights).source(), Storage::Float);
    coarse.setLookup(field.lookup());
    return coarse;
}

}  // namespace woodcock::grid
