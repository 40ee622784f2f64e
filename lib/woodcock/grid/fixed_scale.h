// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace woodcock {

/// The values that the voxels of one brick may take in fixed storage: low + step x code, for codes
/// from 0 to `last`.
struct FixedScale {
    float low = 0, step = 0;

    /// For values from `min` to `max`. Zero, where it lies between, is one of the values; so is
    /// `min`, and none is above `max`, unless signs differ. The error is then at most half of
    /// range / last, with range = max - min, up to the rounding of floats; where signs differ, of
    /// 1.01 range / (last - 1), and values may lie outside by as much. (Below 1e-38 floats are too
    /// coarse for that.)
    /// Throws Error{Input} where signs differ and last steps are more than a float holds.
    static FixedScale of(float min, float max, unsigned last);

    float value(unsigned code) const { return low + step * static_cast<float>(code); }
    /// Of the value nearest to `v`.
    unsigned code(float v, unsigned last) const;
};

}  // namespace woodcock
