// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "woodcock/base/vec.h"

namespace woodcock::light {

/// How a luminaire shines into each direction, from a photometric file of ANSI/IES LM-63 (1986 to
/// 2019), type C. In the luminaire's own axes the vertical angle 0 lies towards -z, 180 towards +z;
/// the horizontal angle 0 lies towards -y and 90 towards -x, as in Cycles' IES texture.
class IesProfile {
public:
    /// What multiplies candela: a light of power 1, intensity 1 / 4 pi, then shines with the file's
    /// candela at 177.83 lumens per watt, those of daylight (D65). As in Cycles.
    static constexpr double fromCandela = 4 * pi / 177.83;

    /// Reads the text of a file. `name` is named in messages, with the line. A TILT table is read
    /// over: it tells of lamps that hang askew. Throws Error{Input}.
    static IesProfile read(std::string_view text, std::string_view name);

    /// Towards a unit vector in the luminaire's axes: linear between the file's angles; 0 beyond
    /// its vertical ones.
    double value(Vec3d direction) const;
    double maximum() const { return maximum_; }
    double mean() const;  ///< over the sphere, exactly

private:
    double at(std::size_t horizontal, std::size_t vertical) const {
        return value_[horizontal * vertical_.size() + vertical];
    }

    std::vector<double> vertical_, horizontal_;  // degrees, ascending; horizontal: 0 to 360
    std::vector<double> value_;                  // horizontal x vertical
    double maximum_ = 0;
};

}  // namespace woodcock::light
