// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "woodcock/medium/medium.h"
#include "woodcock/scene/load.h"

namespace woodcock {

/// The volumes that fill the surface of this name; of an empty name, those that fill none.
Medium buildMedium(const SceneDescription& description, const LoadedScene& loaded,
                   std::string_view inside);

}  // namespace woodcock
