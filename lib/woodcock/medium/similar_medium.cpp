// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/similar_medium.h"

namespace woodcock::medium {

Medium similarMedium(const Medium& medium) {
    Medium similar;
    for (const MediumPart& part : medium.parts) {
        const double kept = 1 - part.g();
        MediumPart::Coefficients c;
        c.absorption = part.absorption();
        c.scattering = part.scattering() * static_cast<float>(kept);
        // The absorption by an albedo below 1 stays as it was.
        c.loss = part.loss() * static_cast<float>(1 / kept);
        similar.parts.push_back(part.with(c));
    }
    return similar;
}

}  // namespace woodcock::medium
