// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace woodcock::test {

/// A small healthy VDB file, and where its parts begin: what damage is aimed at.
struct VdbSample {
    std::string name;
    std::string bytes;
    struct Grid {
        std::size_t begin = 0, topology = 0, voxels = 0, end = 0;
        std::vector<std::uint64_t> leaves;
    };
    std::vector<Grid> grids;
};

/// Every value type, every compression, tiles, many grids, a shared tree, metadata, a stream.
std::vector<VdbSample> healthyVdbs();

/// The bytes of the sample, damaged in the way that `seed` says: bit flips, truncation, absurd
/// sizes and counts, other types, impossible transforms, lies in metadata, offsets that lead
/// nowhere, masks that are full, parts moved about.
std::string damagedVdb(const VdbSample& sample, std::uint64_t seed);

}  // namespace woodcock::test
