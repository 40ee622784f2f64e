// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/value_remap.h"

#include "woodcock/base/error.h"

namespace woodcock::convert {

namespace {

std::string describe(const grid::VoxelCount& voxels, const char* kind) {
    return fmt::format("{} {} voxel{} (first at [{}, {}, {}])", voxels.count, kind,
                       voxels.count == 1 ? "" : "s", voxels.first.x, voxels.first.y,
                       voxels.first.z);
}

}  // namespace

std::string requireSound(const ValueSummary& summary, const std::string& place, bool repair) {
    if (summary.beyond.count > 0)
        throw inputError("{}: --scale and --offset make {}", place,
                         describe(summary.beyond, "infinite"));
    std::string faults;
    if (summary.nan.count > 0) faults = describe(summary.nan, "NaN");
    if (summary.infinite.count > 0)
        faults += (faults.empty() ? "" : ", ") + describe(summary.infinite, "infinite");
    if (faults.empty()) return {};
    if (!repair) throw inputError("{} holds {}; --repair sets them to zero", place, faults);
    return fmt::format("{}: set to zero: {}", place, faults);
}

}  // namespace woodcock::convert
