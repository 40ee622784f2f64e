// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "woodcock/image/film.h"

namespace woodcock::render {

/// The square tiles of a crop, with corners at multiples of `size` pixels. Their order spreads
/// every run of some length over the whole crop, so the cost of the first tiles predicts that of
/// all.
std::vector<image::Film::Window> scatteredTiles(image::Film::Window crop, int size);

/// Tile `index` of `count`, from 0, of those that a picture is shared out by: rows from the top,
/// each from the left. They are as square as their number allows, and of equal size up to a pixel.
/// Throws Error{Usage} where the picture has fewer pixels in a row or column than there are tiles.
image::Film::Window pictureTile(image::Film::Window picture, int index, int count);

}  // namespace woodcock::render
