// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/voxel_scan.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

#include "woodcock/grid/half.h"

namespace woodcock {

namespace {

constexpr float largestFloat = std::numeric_limits<float>::max();

bool isFiniteValue(float v) { return std::abs(v) <= largestFloat; }

template <int C>
bool anyDiffers(const float* voxel, const std::array<float, 3>& from) {
    for (int c = 0; c < C; ++c)
        if (voxel[c] != from[static_cast<std::size_t>(c)]) return true;
    return false;
}

/// One voxel, or `n` equal ones.
template <int C>
void scanVoxel(const float* v, bool active, Vec3i at, std::uint64_t n,
               const std::array<float, 3>& background, VoxelScan& scan) {
    bool nan = false, infinite = false, negative = false;
    for (int c = 0; c < C; ++c) {
        nan |= std::isnan(v[c]);
        infinite |= std::isinf(v[c]);
        negative |= v[c] < 0 && isFiniteValue(v[c]);
    }
    if (nan) scan.nan.add(at, n);
    if (infinite) scan.infinite.add(at, n);
    if (negative) scan.negative.add(at, n);
    if (!active) {
        if (anyDiffers<C>(v, background)) scan.inactiveValues += n;
        return;
    }
    scan.active += n;
    if (nan || infinite) return;
    scan.finite += n;
    for (std::size_t c = 0; c < C; ++c) {
        scan.min[c] = std::min(scan.min[c], v[c]);
        scan.max[c] = std::max(scan.max[c], v[c]);
        scan.sum[c] += static_cast<double>(v[c]) * static_cast<double>(n);
    }
}

/// A leaf without faults, a row of eight voxels at a time: lanes that the compiler can vectorise.
template <int C>
void scanSoundLeaf(const float* values, std::span<const std::uint64_t, 8> activeMask,
                   const std::array<float, 3>& background, VoxelScan& scan) {
    constexpr std::size_t lanes = 8 * C;
    std::array<float, lanes> low, high, outside;
    std::array<double, lanes> sum{};
    std::array<unsigned, lanes> bit;  // of a lane's voxel in a row's mask
    for (std::size_t i = 0; i < lanes; ++i) outside[i] = background[i % C], bit[i] = 1u << (i / C);
    low.fill(largestFloat), high.fill(-largestFloat);
    for (std::size_t row = 0; row < 64; ++row) {
        const float* v = values + row * lanes;
        const auto active = static_cast<unsigned>(activeMask[row / 8] >> (row % 8 * 8) & 0xffu);
        if (active == 0xff) {
            for (std::size_t i = 0; i < lanes; ++i) {
                low[i] = v[i] < low[i] ? v[i] : low[i];
                high[i] = v[i] > high[i] ? v[i] : high[i];
                sum[i] += static_cast<double>(v[i]);
            }
            continue;
        }
        std::array<unsigned, lanes> differs;
        for (std::size_t i = 0; i < lanes; ++i) {
            const bool on = (active & bit[i]) != 0;
            const float below = on ? v[i] : largestFloat, above = on ? v[i] : -largestFloat;
            low[i] = below < low[i] ? below : low[i];
            high[i] = above > high[i] ? above : high[i];
            sum[i] += static_cast<double>(on ? v[i] : 0.0f);
            differs[i] = on || v[i] == outside[i] ? 0 : bit[i];
        }
        unsigned strays = 0;
        for (unsigned d : differs) strays |= d;
        scan.inactiveValues += static_cast<std::uint64_t>(std::popcount(strays));
    }
    std::uint64_t count = 0;
    for (std::uint64_t word : activeMask) count += static_cast<std::uint64_t>(std::popcount(word));
    scan.active += count, scan.finite += count;
    if (count == 0) return;
    for (std::size_t i = 0; i < lanes; ++i) {
        scan.min[i % C] = std::min(scan.min[i % C], low[i]);
        scan.max[i % C] = std::max(scan.max[i % C], high[i]);
        scan.sum[i % C] += sum[i];
    }
}

template <int C>
LeafKind scanLeafOf(const float* values, std::span<const std::uint64_t, 8> activeMask, Vec3i origin,
                    const std::array<float, 3>& background, VoxelScan& scan) {
    constexpr std::size_t lanes = 8 * C;
    std::array<float, lanes> first;
    for (std::size_t i = 0; i < lanes; ++i) first[i] = values[i % C];
    unsigned faulty = 0, varying = 0;
    for (std::size_t row = 0; row < 64; ++row)
        for (std::size_t i = 0; i < lanes; ++i) {
            const float v = values[row * lanes + i];
            faulty |= static_cast<unsigned>(!(v >= 0)) | static_cast<unsigned>(v > largestFloat);
            varying |= static_cast<unsigned>(v != first[i]);
        }
    for (std::size_t row = 0; row < 64 && scan.exactAsHalf; ++row) {
        unsigned exact = 1;
        for (std::size_t i = 0; i < lanes; ++i)
            exact &= static_cast<unsigned>(isExactAsHalf(values[row * lanes + i]));
        scan.exactAsHalf = exact != 0;
    }
    if (faulty) {
        for (int n = 0; n < 512; ++n) {
            const bool active = activeMask[static_cast<std::size_t>(n / 64)] >> (n % 64) & 1u;
            scanVoxel<C>(values + n * C, active, origin + Vec3i{n >> 6, n >> 3 & 7, n & 7}, 1,
                         background, scan);
        }
    } else {
        scanSoundLeaf<C>(values, activeMask, background, scan);
    }
    if (varying) return LeafKind::Varying;
    return anyDiffers<C>(values, background) ? LeafKind::Constant : LeafKind::Background;
}

}  // namespace

void VoxelCount::add(Vec3i at, std::uint64_t n) { add(VoxelCount{n, at}); }

void VoxelCount::add(const VoxelCount& more) {
    if (more.count == 0) return;
    const auto order = [](Vec3i v) { return std::tuple(v.x, v.y, v.z); };
    if (count == 0 || order(more.first) < order(first)) first = more.first;
    count += more.count;
}

void VoxelScan::add(const VoxelScan& more) {
    active += more.active, inactiveValues += more.inactiveValues, finite += more.finite;
    for (std::size_t c = 0; c < 3; ++c) {
        min[c] = std::min(min[c], more.min[c]);
        max[c] = std::max(max[c], more.max[c]);
        sum[c] += more.sum[c];
    }
    nan.add(more.nan), infinite.add(more.infinite), negative.add(more.negative);
    exactAsHalf = exactAsHalf && more.exactAsHalf;
}

LeafKind scanLeaf(std::span<const float> values, int channels,
                  std::span<const std::uint64_t, 8> activeMask, Vec3i origin,
                  const std::array<float, 3>& background, VoxelScan& scan) {
    return channels == 1 ? scanLeafOf<1>(values.data(), activeMask, origin, background, scan)
                         : scanLeafOf<3>(values.data(), activeMask, origin, background, scan);
}

void scanTile(const std::array<float, 3>& value, int channels, bool active, Vec3i origin, int size,
              const std::array<float, 3>& background, VoxelScan& scan) {
    const auto edge = static_cast<std::uint64_t>(size);
    const std::uint64_t voxels = edge * edge * edge;
    for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c)
        scan.exactAsHalf = scan.exactAsHalf && isExactAsHalf(value[c]);
    if (channels == 1)
        scanVoxel<1>(value.data(), active, origin, voxels, background, scan);
    else
        scanVoxel<3>(value.data(), active, origin, voxels, background, scan);
}

void repairValues(std::span<float> values, bool negativeToo) {
    for (float& v : values)
        if (!isFiniteValue(v) || (negativeToo && v < 0)) v = 0;
}

}  // namespace woodcock
