// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/render/batch.h"
#include "woodcock/render/traced_scene.h"

namespace woodcock::render {

/// Several next events near a sun, or a lamp with a grid of depths. In dense media that scatter
/// forwards, nearly all of its light comes from the few events that are near it, and the peak of
/// the phase function makes it noisy. So where the optical depth to it is small, the path's next
/// event is drawn several times: direction, flight, and light at its end. The path goes on along
/// one of them. Each brings an equal share, so the mean stays.
///
/// The n-tuple local estimate of Buras and Mayer 2011, "Efficient unbiased variance reduction
/// techniques for Monte Carlo simulations of radiative transfer in cloudy atmospheres: The
/// solution".
///
/// It is for media that are thickAndPeaked(). To be called after next-event estimation at p.from,
/// and before the path's own direction is drawn. Sets p.sunShare.
template <int N>
void drawSeveralEvents(const TracedScene& traced, Batch<N, false>& batch, std::size_t i);

/// Whether they are drawn at p.from, how many beside the path's own, and the share of each.
template <int N>
bool drawsSeveralEvents(const TracedScene& traced, const PathState<N, false>& p);
/// Of 2, 4 and 6 events, and of optical depths to the sun of 3 and 6 below which they are drawn,
/// these measured best.
inline constexpr int severalEvents = 4;
inline constexpr float nearSun = 6;
inline constexpr float severalEventsShare = 1.0f / (1 + severalEvents);

}  // namespace woodcock::render
