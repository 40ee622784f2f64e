// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/support/plain_grid.h"

#include <algorithm>

#include "woodcock/base/random.h"

namespace woodcock::proof {

namespace {

std::array<int, 3> leafKey(Vec3i v) { return {v.x & ~7, v.y & ~7, v.z & ~7}; }

std::size_t leafOffset(Vec3i v) {
    return static_cast<std::size_t>((v.x & 7) * 64 + (v.y & 7) * 8 + (v.z & 7));
}

/// A number in [0, 1] of ten bits, from a voxel and channel.
float noise(std::uint64_t seed, Vec3i v, int channel) {
    return static_cast<float>(hashOf(seed, v.x, v.y, v.z, channel) % 1025) / 1024;
}

float rough(std::uint64_t seed, Vec3i v, int channel) {
    return noise(seed + 1, v, 0) < 0.33f ? 0 : noise(seed, v, channel);
}

}  // namespace

void PlainGrid::setLeaf(Vec3i origin, const std::function<float(Vec3i, int)>& value) {
    std::vector<float>& values = leaves_[leafKey(origin)];
    for (int i = 0; i < 512; ++i)
        for (int c = 0; c < channels_; ++c)
            values.push_back(value(origin + Vec3i{i >> 6, i >> 3 & 7, i & 7}, c));
    leafOrigins_.push_back(origin);
}

void PlainGrid::setTile(Vec3i origin, int size, std::array<float, 3> value) {
    tiles_.push_back({origin, size, value});
}

float PlainGrid::voxel(Vec3i v, int channel) const {
    if (const auto leaf = leaves_.find(leafKey(v)); leaf != leaves_.end())
        return leaf->second[leafOffset(v) * static_cast<std::size_t>(channels_) +
                            static_cast<std::size_t>(channel)];
    for (const grid::FieldTile& t : tiles_) {
        const Vec3i o = v - t.origin;
        if (std::min({o.x, o.y, o.z}) >= 0 && std::max({o.x, o.y, o.z}) < t.size)
            return t.value[static_cast<std::size_t>(channel)];
    }
    return background(channel);
}

double PlainGrid::trilinear(Vec3d p, int channel) const {
    const Vec3d low{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
    double sum = 0;
    for (int i = 0; i < 8; ++i) {
        const Vec3i side{i & 1, i >> 1 & 1, i >> 2};
        double weight = 1;
        for (int a = 0; a < 3; ++a) weight *= side[a] ? p[a] - low[a] : 1 - (p[a] - low[a]);
        sum += weight * voxel(low.as<int>() + side, channel);
    }
    return sum;
}

grid::Range PlainGrid::range(Vec3i lower, Vec3i upper) const {
    grid::Range r{voxel(lower), voxel(lower)};
    for (int x = lower.x; x <= upper.x; ++x)
        for (int y = lower.y; y <= upper.y; ++y)
            for (int z = lower.z; z <= upper.z; ++z)
                for (int c = 0; c < channels_; ++c) {
                    const float v = voxel({x, y, z}, c);
                    r.add({v, v});
                }
    return r;
}

Box3d PlainGrid::support() const {
    Box3d box;
    const auto differs = [&](Vec3i v) {
        for (int c = 0; c < channels_; ++c)
            if (voxel(v, c) != background(c)) return true;
        return false;
    };
    for (Vec3i leaf : leafOrigins_)
        for (int i = 0; i < 512; ++i) {
            const Vec3i v = leaf + Vec3i{i >> 6, i >> 3 & 7, i & 7};
            if (differs(v)) box.add(v.as<double>());
        }
    for (const grid::FieldTile& t : tiles_)
        if (differs(t.origin)) {
            const int last = t.size - 1;
            box.add(t.origin.as<double>());
            box.add((t.origin + Vec3i{last, last, last}).as<double>());
        }
    if (box.empty()) return box;
    return {box.lower - Vec3d{1, 1, 1}, box.upper + Vec3d{1, 1, 1}};
}

grid::FieldSource PlainGrid::source() const {
    grid::FieldSource s;
    s.channels = channels_, s.background = background_;
    s.leafOrigins = leafOrigins_, s.tiles = tiles_;
    s.copyLeaf = [this](std::size_t i, std::span<float> values) {
        const std::vector<float>& leaf = leaves_.at(leafKey(leafOrigins_[i]));
        std::copy(leaf.begin(), leaf.end(), values.begin());
    };
    return s;
}

PlainGrid mixedGrid(std::uint64_t seed, int channels, std::array<float, 3> background) {
    PlainGrid grid(channels, background);
    for (int x = -2; x < 2; ++x)
        for (int y = -1; y < 2; ++y)
            for (int z = -2; z < 1; ++z) {
                const Vec3i origin{x * 8, y * 8, z * 8};
                switch (hashOf(seed, x, y, z) % 5) {
                    case 0:
                    case 1:
                        grid.setLeaf(origin, [&](Vec3i v, int c) { return rough(seed, v, c); });
                        break;
                    case 2:
                        grid.setLeaf(origin, [](Vec3i v, int c) {
                            return static_cast<float>(v.x + 2 * v.y - v.z + 64 * (c + 1)) / 256;
                        });
                        break;
                    case 3:
                        grid.setLeaf(origin, [](Vec3i, int c) {
                            return 0.5f + 0.125f * static_cast<float>(c);
                        });
                        break;
                    default:
                        break;
                }
            }
    grid.setTile({16, 0, -8}, 8, {0.75f, 0.5f, 0.25f});
    return grid;
}

PlainGrid scatteredGrid(std::uint64_t seed, int channels, std::array<float, 3> background) {
    PlainGrid grid = mixedGrid(seed, channels, background);
    const auto noisy = [&](Vec3i v, int c) { return rough(seed, v, c); };
    for (Vec3i origin : {Vec3i{-3000, 400, 8}, Vec3i{2992, -904, -1600}, Vec3i{-136, -8, 120},
                         Vec3i{256, 120, -8}, Vec3i{-72, 4096, 4088}})
        grid.setLeaf(origin, noisy);
    grid.setTile({128, 0, -128}, 128, {0.25f, 0.5f, 1});
    grid.setTile({-256, -128, 0}, 128, {1, 0.25f, 0});
    grid.setTile({-128, -128, -128}, 8, {0.0625f, 0, 1});
    grid.setTile({-4096, 4096, -4096}, 4096, {0.125f, 0.25f, 0.375f});
    grid.setTile({4096, -8192, 0}, 4096, {0.5f, 0.5f, 0.5f});
    return grid;
}

}  // namespace woodcock::proof
