// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/proof/proof.h"

namespace woodcock::proof {

// The parts of properties(), one file each.
std::vector<Check> propertiesOfRays();
std::vector<Check> propertiesOfPaths();
std::vector<Check> propertiesOfPictures();
std::vector<Check> propertiesOfFilms();

}  // namespace woodcock::proof
