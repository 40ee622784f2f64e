// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/corrected_transmittance.h"

#include <algorithm>
#include <cmath>

#include "woodcock/medium/optical_depth.h"

namespace woodcock::medium {

namespace {

/// exp(-depth). The library's function takes long where the result is no normal float.
float decay(float depth) { return depth < 87 ? std::exp(-depth) : 0.0f; }

}  // namespace

template <int N>
Spectrum<N> correctedTransmittance(const Medium& medium, const DepthGrid& grid, Vec3d origin,
                                   Vec3d direction, Spectrum<N> weight, RandomStream& random,
                                   TrackingCounters& counters) {
    const auto depths = grid.at<N>(origin);
    Spectrum<N> transmittance;
    float probability = rarestCorrection;
    for (int c = 0; c < N; ++c) {
        const DepthGrid::Depth& d = depths[static_cast<std::size_t>(c)];
        transmittance[c] = decay(d.depth);
        // At least the difference of the transmittances at the nodes.
        const float unsure = decay(d.least) * std::min(1.0f, d.most - d.least);
        probability = std::max(probability, weight[c] * unsure);
    }
    if (probability < 1 && random.uniform() >= double{probability}) return transmittance;
    const Spectrum<N> exact = exactTransmittance<N>(medium, origin, direction, counters);
    return transmittance +
           (exact - transmittance) * static_cast<float>(1 / std::min(1.0f, probability));
}

template Spectrum<1> correctedTransmittance(const Medium&, const DepthGrid&, Vec3d, Vec3d,
                                            Spectrum<1>, RandomStream&, TrackingCounters&);
template Spectrum<3> correctedTransmittance(const Medium&, const DepthGrid&, Vec3d, Vec3d,
                                            Spectrum<3>, RandomStream&, TrackingCounters&);

}  // namespace woodcock::medium
