// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/proof/checks/measure.h"

namespace woodcock::proof::slab {

// Slabs of vertical depth 1 where the scale is 1: the first lines of a [[volume]].

inline constexpr const char* box = "box = { min = [-1e7, 0, -1e7], max = [1e7, 1, 1e7] }\n";
inline constexpr const char* even = "file = \"even.vdb\"\n";
inline constexpr const char* layered = "file = \"layered.vdb\"\n";
inline constexpr const char* kinds[] = {box, even, layered};

/// The files of even and layered ones.
inline void write(const Lab& lab) {
    writeSlab(lab, "even.vdb", {1, 1, 1, 1});
    writeSlab(lab, "layered.vdb", {5, 0, 1, 0.125, 0, 0, 8, 3, 0.5, 2, 0, 4});
}
inline const char* nameOf(const char* kind) {
    return kind == box ? "box" : kind == even ? "even voxels" : "layered voxels";
}

}  // namespace woodcock::proof::slab
