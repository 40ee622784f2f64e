// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "woodcock/image/film.h"

namespace woodcock {

/// A crop's square tiles, whose corners are at multiples of `size`, in an order in which every run
/// of some length is spread over the whole crop: what the first tiles cost is what all cost.
std::vector<Film::Window> scatteredTiles(Film::Window crop, int size);

}  // namespace woodcock
