// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "woodcock/medium/tracking.h"

namespace woodcock {

/// Ray marching in place of tracking: biased, its cost known beforehand.
///
/// A ray is cut into steps of at most `step` voxels (in index space along the ray, each part by its
/// own), none longer than a cell of MediumPart::marchCells(); where a cell is empty or constant
/// there is one exact step and no look-up. Each step looks at evenly random points of its own
/// (stratified, Pauly et al. 2000) and gets an optical depth: see `jackknife`. Extinction is then
/// taken as even within the step. So means are exact where the field is constant, whatever the
/// step.
struct MarchSettings {
    double step = 1;  ///< voxels
    /// False: the depth x at one point stands for the step. exp(-x) is convex, so transmittance is
    /// too large by a factor of about 1 + var(x) / 2 for each step (Jensen): of third order in the
    /// step where the field is smooth.
    ///
    /// True: two points, x0 and x1, and exp(-(x0 + x1) / 2) cos((x0 - x1) / 2): Peters 2025,
    /// "Jackknife Transmittance and MIS Weight Estimation", eq. 4, without bias where x is normally
    /// distributed (Gray et al. 1973). There x is the depth of the whole ray. As steps are
    /// independent, the product of the steps' own estimates is the mean of that formula over all
    /// ways to make two rays of the same points: the same mean, less variance, and negative only
    /// where one step's two depths differ by more than pi; such steps count as opaque. The factor
    /// is about 1 + k3 / 12 - k4 / 48 for each step, with x's third and fourth cumulants: of sixth
    /// order.
    bool jackknife = true;
};

/// Makes what marching needs. Throws Error{Usage} where the step is not above 0, or so small that
/// a ray might need more than a million look-ups, and where a part's extinctionVaries().
void prepareMarch(const Medium& medium, const MarchSettings& settings);

/// As trackDistance(), from an optical depth drawn for one channel; the channel is drawn by
/// throughput x MediumPart::channelWeight(), and its estimate serves all of them by the balance
/// heuristic over the marched transmittances: Miller et al. 2019, "A null-scattering path integral
/// formulation of light transport", eq. 13. Absorption is a weight. Parts that overlap are
/// independent processes: each marches to its own event, and the nearest one happens.
template <int N>
void marchDistance(const Medium& medium, const MarchSettings& settings,
                   std::span<DistanceQuery<N>> queries, TrackingCounters& counters);

/// As trackTransmittance().
template <int N>
void marchTransmittance(const Medium& medium, const MarchSettings& settings,
                        std::span<TransmittanceQuery<N>> queries, TrackingCounters& counters);

}  // namespace woodcock
