// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

namespace woodcock {

/// How numbers go from one key to the next.
enum class Interpolation { Linear, Smooth, Constant };
/// Their names in scene files, in the same order.
inline const std::array<std::string, 3> interpolationNames{"linear", "smooth", "constant"};

/// Several numbers as functions of the frame, from their values at some frames, the keys. Before
/// the first key and after the last one, they stay as they are there.
///
/// Smooth is the monotone cubic of Fritsch and Carlson 1980, "Monotone Piecewise Cubic
/// Interpolation": between two keys, a number never leaves the range of its two values. Its slope
/// is continuous, and 0 at extremes and at both ends of a pause. At the first and the last key it
/// is that of the straight line to the neighbour. Constant is the value of the last key.
class Keyframes {
public:
    /// Frames in increasing order; the values of each, all equally many.
    Keyframes(std::vector<double> frames, std::vector<std::vector<double>> values,
              Interpolation interpolation);

    const std::vector<double>& frames() const { return frames_; }
    const std::vector<std::vector<double>>& values() const { return values_; }
    Interpolation interpolation() const { return interpolation_; }

    std::vector<double> at(double frame) const;

    /// The key at or before a frame, and how far the frame is on the way to the next: 0 to 1. The
    /// last key but one is the last that has a way.
    struct Place {
        std::size_t key;
        double share;
    };
    Place placeOf(double frame) const;

private:
    std::vector<double> frames_;
    std::vector<std::vector<double>> values_;
    std::vector<std::vector<double>> slopes_;  // per frame, at each key; of Smooth
    Interpolation interpolation_;
};

}  // namespace woodcock
