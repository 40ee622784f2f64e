// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "woodcock/medium/look_up.h"

namespace woodcock::medium {

/// Integrates the density of a part along each of so many steps of a ray, by two points in each of
/// its cells: quick, and good enough for what is corrected later. Calls add(step, channel,
/// integral) for `channels` of the field, of which one that has a single channel repeats it.
template <class Add>
void integrateSteps(const MediumPart& part, const grid::IndexRay& ray, int steps, double spacing,
                    int channels, Add&& add) {
    constexpr double gauss = 0.57735026918962576;
    const double perSpacing = 1 / spacing;
    PartWalk walk(part, ray, steps * spacing);
    for (grid::Segment s; walk.next(s);) {
        if (!(s.range.max > 0)) continue;
        // Rounding may put a segment a little beyond the ends of the line.
        int k = std::clamp(static_cast<int>(s.t0 * perSpacing), 0, steps - 1);
        for (double a = s.t0; a < s.t1; ++k) {
            const double b = k + 1 < steps ? std::clamp((k + 1) * spacing, a, s.t1) : s.t1;
            const double middle = (a + b) / 2, half = (b - a) / 2;
            for (int c = 0; c < channels; ++c) {
                double f = 2 * double{s.range.max};
                if (s.range.min != s.range.max) {
                    const grid::Field& field = *part.field();
                    const int channel = field.channels() == 1 ? 0 : c;
                    f = double{field.trilinear(ray.at(middle - gauss * half), channel)} +
                        double{field.trilinear(ray.at(middle + gauss * half), channel)};
                }
                add(k, c, half * f);
            }
            a = b;
        }
    }
}

}  // namespace woodcock::medium
