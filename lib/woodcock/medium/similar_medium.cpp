// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/similar_medium.h"

#include "woodcock/base/error.h"

namespace woodcock::medium {

Medium similarMedium(const Medium& medium) {
    Medium similar;
    for (const MediumPart& part : medium.parts) {
        const PhaseFunction& phase = part.phase();
        const double kept = 1 - phase.meanCosine();
        MediumPart::Coefficients c;
        c.absorption = part.absorption();
        if (phase.chromatic()) {
            if (part.albedo())
                throw usageError(
                    "similarity needs one loss for all colours; a phase function of kind {} with "
                    "three columns has none beside a grid of albedo",
                    phase.name());
            c.scattering = part.scattering() * (Rgb(1.0f) - phase.meanCosines());
        } else {
            c.scattering = part.scattering() * static_cast<float>(kept);
        }
        // The absorption by an albedo below 1 stays as it was.
        c.loss = part.loss() * static_cast<float>(1 / kept);
        similar.parts.push_back(part.with(c));
    }
    return similar;
}

}  // namespace woodcock::medium
