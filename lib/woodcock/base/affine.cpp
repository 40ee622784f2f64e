// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/affine.h"

#include <fmt/format.h>

namespace woodcock {

std::string flawOf(const Affine3d& map) {
    constexpr double shortest = 1e-50, longest = 1e50;
    // By hypot: squares may overflow or underflow a double.
    const auto sizeOf = [](Vec3d v) {
        return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    };
    double volume = 1;
    for (const Vec3d& axis : map.column) {
        if (!isFinite(axis) || !isFinite(map.translation)) return "is not finite";
        const double size = sizeOf(axis);
        if (size > 0 && !(size >= shortest && size <= longest))
            return fmt::format("has an axis {:.3g} long; {:.0e} to {:.0e} is possible", size,
                               shortest, longest);
        volume *= length(axis);
    }
    if (const double far = sizeOf(map.translation); far > longest)
        return fmt::format("moves by {:.3g}; up to {:.0e} is possible", far, longest);
    // Below this, what is left of the smallest axis is rounding.
    if (!(std::abs(map.determinant()) > 1e-12 * volume))
        return fmt::format("is singular: it flattens space (its determinant is {:.3g})",
                           map.determinant());
    return {};
}

}  // namespace woodcock
