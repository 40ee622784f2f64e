// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "woodcock/render/needs.h"

namespace woodcock {

/// "uses scattering, light sampling": the parts of the path loop that a scene runs.
std::string usedOf(const Needs& needs);
/// "has no use for emission, surfaces": the others; empty: there are none.
std::string unusedOf(const Needs& needs);

}  // namespace woodcock
