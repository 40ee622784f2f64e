// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/grid/field_source.h"

namespace woodcock {

/// What glows of a grid of temperatures: blackbodyRadiance(scale x value + offset) of every voxel,
/// three channels. It is the emission that is interpolated, not the temperature, so that q stays
/// linear in its field. Nothing glows where the grid holds its background value, whatever the
/// offset.
FieldSource blackbodySource(FieldSource temperatures, double scale, double offset);

}  // namespace woodcock
