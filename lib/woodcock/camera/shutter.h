// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace woodcock::camera {

/// When the shutter opens and closes, in frames after the frame of the picture; negative: before
/// it. A path is drawn at one time u of the shutter, from 0 where it opens to 1 where it closes.
struct Shutter {
    double open = 0, close = 0;

    /// Frames for which it is open.
    double length() const { return close - open; }
    /// The time u, in frames.
    double frames(double u) const { return open + u * length(); }
    bool operator==(const Shutter&) const = default;
};

}  // namespace woodcock::camera
