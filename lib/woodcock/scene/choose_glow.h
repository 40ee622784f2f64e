// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "woodcock/scene/description.h"
#include "woodcock/scene/load.h"

namespace woodcock::scene {

/// What completeScene() does where a volume of no scene file holds fire, by the usual names of its
/// grids: the volume glows as a black body. Temperatures in kelvins are taken as they are, if they
/// go beyond 1300. Else the largest value of the temperatures (or, where there are none, of the
/// flames) is fireTemperature. It is as bright as a fire of its size has to be beside the lights of
/// chooseLights(). Its smoke is dark, unless the user says what albedo it has. Returns why, in a
/// part of a sentence; empty: nothing was chosen.
std::string chooseGlow(SceneDescription& scene, const LoadedVolume& loaded, size_t index);

inline constexpr double fireTemperature = 2000;  ///< kelvins

}  // namespace woodcock::scene
