// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "woodcock/proof/proof.h"

namespace woodcock::proof {

// One file each.
std::vector<Check> closedForms();
std::vector<Check> singleScattering();
std::vector<Check> slabs();
std::vector<Check> surfaces();
std::vector<Check> surfacesTogether();
std::vector<Check> roughSurfaces();
std::vector<Check> properties();
std::vector<Check> sampling();
std::vector<Check> phaseFunctions();
std::vector<Check> lightSampling();
std::vector<Check> aimedPoints();
std::vector<Check> flatLights();
std::vector<Check> lampsInFog();
std::vector<Check> lightDepths();
std::vector<Check> lanes();
std::vector<Check> skies();
std::vector<Check> extremes();
std::vector<Check> emission();
std::vector<Check> motion();
std::vector<Check> motionOfTransforms();
std::vector<Check> motionOfLights();

}  // namespace woodcock::proof
