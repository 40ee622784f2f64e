// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/octaves.h"

namespace woodcock::medium {

Medium octaveMedium(const Medium& medium, int i) {
    Medium dimmed;
    for (const MediumPart& part : medium.parts) {
        MediumPart::Coefficients c;
        c.absorption = part.extinction() * static_cast<float>(octave::extinction(i));
        c.phase = part.phase().towardsIsotropic(octave::phase(i));
        dimmed.parts.push_back(part.with(c));
    }
    return dimmed;
}

}  // namespace woodcock::medium
