// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "woodcock/base/error.h"
#include "woodcock/grid/field.h"

namespace woodcock::grid {

namespace {

constexpr double largestFloat = std::numeric_limits<float>::max();

/// The smallest number of eight binary digits that is not below `v`. Its product with a code of 16
/// bits is a float without rounding.
double ceilToEightDigits(double v) {
    int exponent = 0;
    const double digits = std::frexp(v, &exponent);
    return std::ldexp(std::ceil(digits * 256), exponent - 8);
}

}  // namespace

FixedScale FixedScale::of(float min, float max, unsigned last) {
    const double range = double{max} - min;
    if (min < 0 && max >= 0) {
        const double step = std::max(ceilToEightDigits(range / (last - 1)),
                                     double{std::numeric_limits<float>::min()});
        if (!(step * last <= largestFloat))
            throw inputError(
                "the values of one brick differ by more than fixed storage can hold; use float "
                "storage");
        return {static_cast<float>(-std::ceil(-min / step) * step), static_cast<float>(step)};
    }
    auto step = static_cast<float>(range / last);
    // Holds whether or not the compiler fuses value()'s multiplication and addition.
    const float steps = static_cast<float>(last);
    while (min + step * steps > max || std::fma(step, steps, min) > max)
        step = std::nextafter(step, 0.0f);
    return {min, step};
}

unsigned FixedScale::code(float v, unsigned last) const {
    if (!(step > 0)) return 0;
    const double nearest = std::floor((double{v} - low) / step + 0.5);
    return static_cast<unsigned>(std::clamp(nearest, 0.0, static_cast<double>(last)));
}

}  // namespace woodcock::grid
