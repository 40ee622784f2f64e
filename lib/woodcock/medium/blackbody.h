// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/base/spectrum.h"
#include "woodcock/grid/field_source.h"

namespace woodcock::medium {

/// Colour of a black body at `kelvin` > 0, of luminance 1: Planck's law seen by the CIE's standard
/// observer of 1931, in linear Rec.709. Below some 1900 K it is redder than any colour of that
/// space, and blue is negative; below 900 K green is negative too. Below 500 K it stays that of
/// 500 K.
Rgb blackbodyColour(double kelvin);

/// blackbodyColour() times the whole radiance of a black body, 1e-6 sigma T^4 / pi: millions of
/// watts per square metre and steradian. Zero at and below 0 K. As in Cycles' Principled Volume.
Rgb blackbodyRadiance(double kelvin);

/// The emission of a grid of temperatures: blackbodyRadiance(scale x value + offset) of every
/// voxel, in three channels. The emission is interpolated, not the temperature, so that it is
/// linear in its field. It is zero where the grid holds its background value, whatever the offset.
grid::FieldSource blackbodySource(grid::FieldSource temperatures, double scale, double offset);

}  // namespace woodcock::medium
