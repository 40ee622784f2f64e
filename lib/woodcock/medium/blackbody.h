// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/base/spectrum.h"

namespace woodcock {

/// Colour of a black body at `kelvin` > 0, of luminance 1: Planck's law seen by the CIE's standard
/// observer of 1931, in linear Rec.709. Below some 1900 K it is redder than any colour of that
/// space: blue is negative then, and below 900 K green is too. Below 500 K as at 500 K.
Rgb blackbodyColour(double kelvin);

/// blackbodyColour() times all that a black body radiates, 1e-6 sigma T^4 / pi: millions of watts
/// per square metre and steradian. Zero at and below 0 K. So do Cycles and its Principled Volume.
Rgb blackbodyRadiance(double kelvin);

}  // namespace woodcock
