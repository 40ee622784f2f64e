// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/proof/proof.h"

namespace woodcock::proof {

// What properties() is made of, one file each.
std::vector<Check> propertiesOfRays();
std::vector<Check> propertiesOfPaths();
std::vector<Check> propertiesOfPictures();
std::vector<Check> propertiesOfFilms();

}  // namespace woodcock::proof
