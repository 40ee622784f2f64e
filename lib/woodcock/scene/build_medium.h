// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "woodcock/medium/medium.h"
#include "woodcock/scene/load.h"

namespace woodcock::scene {

/// The volumes that fill the surface of this name; of an empty name, those that fill none.
medium::Medium buildMedium(const SceneDescription& description, const LoadedScene& loaded,
                           std::string_view inside);

/// The volume that each part of that medium comes from.
std::vector<size_t> volumesOfParts(const SceneDescription& description, const LoadedScene& loaded,
                                   std::string_view inside);

}  // namespace woodcock::scene
