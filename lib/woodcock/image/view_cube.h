// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "woodcock/image/display.h"

namespace woodcock::image {

/// A display transform as a table, for programs without OpenColorIO: `side`^3 colours of three
/// bytes, red fastest. Node i of an axis stands for the light 2^(low + i / (side - 1) (high - low))
/// - 2^low, so that the first one is 0.
struct ViewCube {
    int side = 33;
    double low = -10, high = 7;
    std::vector<unsigned char> rgb;
};

ViewCube bakeView(const DisplayTransform& transform);

}  // namespace woodcock::image
