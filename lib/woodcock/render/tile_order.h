// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "woodcock/image/film.h"

namespace woodcock::render {

/// The square tiles of a crop, with corners at multiples of `size` pixels. Their order spreads
/// every run of some length over the whole crop, so the cost of the first tiles predicts that of
/// all.
std::vector<image::Film::Window> scatteredTiles(image::Film::Window crop, int size);

}  // namespace woodcock::render
