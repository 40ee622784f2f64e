// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "woodcock/grid/voxel_scan.h"

namespace woodcock::convert {

/// Remapping of values, in this order: v x scale + offset, clamped to [low, high], then zero where
/// below the threshold. A colour is below it where all of its channels are.
struct ValueRemap {
    double scale = 1, offset = 0;
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    double threshold = -std::numeric_limits<double>::infinity();

    bool identity() const { return *this == ValueRemap{}; }
    bool operator==(const ValueRemap&) const = default;
};

struct ValueOptions {
    ValueRemap remap{};
    double tolerance = 0;  ///< values this near to zero become the inactive background
    bool repair = false;   ///< NaN and infinite values become zero, instead of an error
};

/// Statistics of a pass over the values.
struct ValueSummary {
    grid::VoxelCount nan, infinite;                        ///< as they came
    grid::VoxelCount beyond;                               ///< made infinite by the remapping
    double min = std::numeric_limits<double>::infinity();  ///< of the finite ones that came
    double max = -min;
    std::uint64_t active = 0;  ///< voxels that are left

    void add(const ValueSummary& more) {
        nan.add(more.nan);
        infinite.add(more.infinite);
        beyond.add(more.beyond);
        min = std::min(min, more.min);
        max = std::max(max, more.max);
        active += more.active;
    }
};

/// Remaps the channels of one voxel. False where all of them become zero, within the tolerance;
/// they are exactly zero then.
template <class Value>
bool remapVoxel(Value* values, int channels, Vec3i at, const ValueOptions& options,
                ValueSummary& summary) {
    const ValueRemap& remap = options.remap;
    bool sound = true, aboveThreshold = false, visible = false;
    for (int c = 0; c < channels; ++c) {
        const auto v = static_cast<double>(values[c]);
        if (!std::isfinite(v)) {
            (std::isnan(v) ? summary.nan : summary.infinite).add(at);
            sound = false;
            break;
        }
        summary.min = std::min(summary.min, v);
        summary.max = std::max(summary.max, v);
        double now = v;
        if (!remap.identity()) {
            now = std::min(std::max(v * remap.scale + remap.offset, remap.low), remap.high);
            values[c] = static_cast<Value>(now);
            if (!std::isfinite(values[c])) {
                summary.beyond.add(at);
                sound = false;
                break;
            }
        }
        aboveThreshold = aboveThreshold || now >= remap.threshold;
        visible = visible || std::abs(now) > options.tolerance;
    }
    if (sound && aboveThreshold && visible) {
        ++summary.active;
        return true;
    }
    for (int c = 0; c < channels; ++c) values[c] = 0;
    return false;
}

/// Throws Error{Input}, naming `place`, where values were not finite and are not to be repaired, or
/// became infinite. Returns a note about what was repaired, or an empty text.
std::string requireSound(const ValueSummary& summary, const std::string& place, bool repair);

}  // namespace woodcock::convert
