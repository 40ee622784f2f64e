// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/compare/picture.h"

namespace woodcock::compare {

/// Averages a picture over areas, to a size that is not larger in either direction. Standard errors
/// follow. `sharedNoise` becomes the ratio of the variance of a mean over many pixels to that for
/// independent pixels.
void shrink(Picture& picture, int width, int height);

}  // namespace woodcock::compare
