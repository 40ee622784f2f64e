// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "woodcock/render/session.h"

namespace woodcock::tool {

/// The noise (Film::noise()) beyond which a picture of a file alone needs no more samples.
inline constexpr double goodNoise = 0.04;

/// The work on a pixel that a picture of a file alone takes at most, in cells crossed and
/// collisions met, with all that is done there. Of smoke, fire and two clouds, a unit takes 0.17 to
/// 0.24 microseconds of a core. So 960 x 540 pixels take at most 56 s on two cores.
inline constexpr double mostWork = 900;

struct ChosenSamples {
    int perPixel = 0;
    double noise = 0;      ///< expected; infinite: unknown
    bool limited = false;  ///< by mostWork
};

/// How many samples a picture needs for goodNoise, or as many as mostWork allows, by what
/// renderTrial() found. It follows from counts and not from seconds, so the same file gives the
/// same picture on every machine. At least 4, and at most 1024.
ChosenSamples chooseSamples(const render::RenderResult& trial);

/// "chosen for a noise of about 4 %", or what limits them.
std::string describe(const ChosenSamples& chosen);

}  // namespace woodcock::tool
