// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "woodcock/medium/medium.h"

namespace woodcock::medium {

/// Multiple scattering as a sum of single scatterings, "octaves": of octave i, sigma_s is
/// multiplied by a^i, the extinction towards the light by b^i, and the phase function's g by c^i
/// (PhaseFunction::towardsIsotropic).
/// Wrenninge, Kulla and Lundqvist 2013, "Oz: The Great and Volumetric", with their a = b = c = 1/2;
/// also Hillaire 2016, "Physically Based Sky, Atmosphere and Cloud Rendering in Frostbite". The
/// paper requires a <= b, or energy would be created.
namespace octave {

inline double amount(int i) { return std::ldexp(1.0, -i); }      ///< a^i
inline double extinction(int i) { return std::ldexp(1.0, -i); }  ///< b^i
inline double phase(int i) { return std::ldexp(1.0, -i); }       ///< c^i

/// Sum of amount(i) over n octaves.
inline double total(int n) { return 2 - std::ldexp(1.0, 1 - n); }
/// One of n octaves, in proportion to amount(); u in [0, 1).
inline int draw(int n, double u) {
    return std::min(static_cast<int>(-std::log2(1 - u * total(n) / 2)), n - 1);
}

}  // namespace octave

/// The medium that light of octave i passes after its scattering: it only absorbs, with b^i
/// sigma_t. Its parts have the phase functions of that scattering. It shares the fields and their
/// bounds. Emission is left out.
Medium octaveMedium(const Medium& medium, int i);

}  // namespace woodcock::medium
