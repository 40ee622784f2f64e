// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/compare/picture.h"

namespace woodcock {

/// Averages over areas to a size that is not larger in either direction; errors go with it, and
/// `sharedNoise` says how much more a mean over many pixels varies than independent ones would.
void shrink(Picture& picture, int width, int height);

}  // namespace woodcock
