// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "woodcock/medium/tracking.h"

namespace woodcock::medium {

/// Ray marching in place of tracking. It is biased, and its cost is known beforehand.
///
/// A ray is cut into steps of at most `step` voxels (in index space along the ray, for each part
/// separately), none longer than a cell of MediumPart::marchCells(). An empty or constant cell is
/// one exact step without a lookup. In every other step the field is looked up at uniformly random
/// points of the step (stratified, Pauly et al. 2000), which give its optical depth: see
/// `jackknife`. Extinction is then taken as constant within the step. So means are exact where the
/// field is constant, whatever the step.
struct MarchSettings {
    double step = 1;  ///< voxels
    /// False: the depth x at one point is taken for the step. exp(-x) is convex, so transmittance
    /// is too large, by a factor of about 1 + var(x) / 2 for each step (Jensen). Where the field is
    /// smooth, this bias is of third order in the step.
    ///
    /// True: two points, x0 and x1, and exp(-(x0 + x1) / 2) cos((x0 - x1) / 2): Peters 2025,
    /// "Jackknife Transmittance and MIS Weight Estimation", eq. 4, without bias where x is normally
    /// distributed (Gray et al. 1973). In the paper x is the depth of the whole ray. Steps are
    /// independent, so the product of the steps' estimates is the mean of that formula over all
    /// ways to make two rays of the same points. It has the same mean and less variance. It is
    /// negative only where the two depths of one step differ by more than pi; such steps count as
    /// opaque. The bias is a factor of about 1 + k3 / 12 - k4 / 48 for each step, with the third
    /// and fourth cumulants of x: of sixth order.
    bool jackknife = true;
};

/// Makes the cells that marching needs. Throws Error{Usage} where the step is not above 0, where it
/// is so small that a ray might need more than a million lookups, and where a part's
/// extinctionVaries().
void prepareMarch(const Medium& medium, const MarchSettings& settings);

/// As trackDistance(), from an optical depth drawn for one channel. The channel is drawn in
/// proportion to throughput x MediumPart::channelWeight(). The balance heuristic over the marched
/// transmittances makes it serve all channels: Miller et al. 2019, "A null-scattering path integral
/// formulation of light transport", eq. 13. Absorption is a weight. Overlapping parts are
/// independent processes: each marches to its own event, and the nearest one happens.
template <int N>
void marchDistance(const Medium& medium, const MarchSettings& settings,
                   std::span<DistanceQuery<N>> queries, TrackingCounters& counters);

/// As trackTransmittance().
template <int N>
void marchTransmittance(const Medium& medium, const MarchSettings& settings,
                        std::span<TransmittanceQuery<N>> queries, TrackingCounters& counters);

}  // namespace woodcock::medium
