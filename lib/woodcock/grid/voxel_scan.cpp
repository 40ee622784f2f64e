// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/voxel_scan.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

#include "woodcock/grid/half.h"

namespace woodcock::grid {

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

/// A leaf without faults, a word of the mask at a time. It has as many lanes as voxels: shorter
/// loops would be unrolled instead of vectorised.
template <int C>
void scanSoundLeaf(const float* values, std::span<const std::uint64_t, 8> activeMask,
                   const std::array<float, 3>& background, VoxelScan& scan) {
    constexpr std::size_t lanes = 64 * C;
    std::array<float, lanes> low, high;
    std::array<double, lanes> sum{};
    low.fill(largestFloat), high.fill(-largestFloat);
    std::uint64_t count = 0;
    for (std::uint64_t active : activeMask) {
        const float* const v = values;
        values += lanes;
        count += static_cast<std::uint64_t>(std::popcount(active));
        if (active == ~std::uint64_t{0}) {
            for (std::size_t i = 0; i < lanes; ++i) {
                low[i] = v[i] < low[i] ? v[i] : low[i];
                high[i] = v[i] > high[i] ? v[i] : high[i];
                sum[i] += static_cast<double>(v[i]);
            }
            continue;
        }
        for (std::size_t n = 0; n < 64; ++n) {
            if (!(active >> n & 1u)) {
                scan.inactiveValues += anyDiffers<C>(v + n * C, background);
                continue;
            }
            for (std::size_t i = n * C; i < (n + 1) * C; ++i) {
                low[i] = std::min(low[i], v[i]), high[i] = std::max(high[i], v[i]);
                sum[i] += static_cast<double>(v[i]);
            }
        }
    }
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
    constexpr std::size_t size = 512 * C, part = 64 * C;
    unsigned faulty = 0, varying = 0;
    for (std::size_t i = 0; i < size; ++i)
        faulty |= (values[i] >= 0 ? 0u : 1u) | (values[i] > largestFloat ? 1u : 0u);
    for (std::size_t i = C; i < size; ++i) varying |= values[i] != values[i - C] ? 1u : 0u;
    for (std::size_t first = 0; first < size && scan.exactAsHalf; first += part) {
        unsigned exact = 1;
        for (std::size_t i = first; i < first + part; ++i)
            exact &= isExactAsHalf(values[i]) ? 1u : 0u;
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

}  // namespace woodcock::grid
