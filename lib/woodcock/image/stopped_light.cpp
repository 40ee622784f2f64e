// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/stopped_light.h"

#include <cmath>

namespace woodcock::image {

double StoppedLight::Stop::amountBefore(double depth) const {
    if (depth >= far) return amount();
    if (depth <= near) return 0;
    const double x = (depth - near) / (far - near);
    const bool exponential = before > 0 && after > 0;
    const double left =
        exponential ? before * std::pow(after / before, x) : before + x * (after - before);
    return share * (before - left);
}

}  // namespace woodcock::image
