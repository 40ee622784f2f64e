// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "woodcock/base/affine.h"

namespace woodcock::oracle {

/// The voxels of a float grid with background 0, copied densely straight from OpenVDB.
struct VdbValues {
    VdbValues(const std::filesystem::path& file, const std::string& grid);

    Box3i box;  ///< of the active voxels
    Affine3d worldFromIndex;
    double largest = 0;

    double at(Vec3i v) const {
        for (int i = 0; i < 3; ++i)
            if (v[i] < box.lower[i] || v[i] > box.upper[i]) return 0;
        return values_[index(v)];
    }

private:
    std::size_t index(Vec3i v) const {
        const Vec3i p = v - box.lower, n = box.upper - box.lower + Vec3i{1, 1, 1};
        return (static_cast<std::size_t>(p.x) * static_cast<std::size_t>(n.y) +
                static_cast<std::size_t>(p.y)) *
                   static_cast<std::size_t>(n.z) +
               static_cast<std::size_t>(p.z);
    }
    std::vector<float> values_;
};

/// OpenVDB's own memUsage() of a float grid's tree, everything loaded.
std::size_t vdbTreeBytes(const std::filesystem::path& file, const std::string& grid);

}  // namespace woodcock::oracle
