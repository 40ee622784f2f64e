// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "woodcock/grid/field.h"

namespace woodcock {

/// A cube of so many bricks (about), each of which varies: a field that has nothing but values.
Field fieldOfBricks(std::size_t bricks);

/// Reads a field at `count` random places of its support, by one tap of stochastic interpolation as
/// the trackers do, and returns the sum of what it found. `dependent`: each place is known once the
/// value before it is, so that a look has to end before the next begins; else many may be under way
/// at once. These are the limits of what a path tracer can ask of the machine.
double lookAtRandom(const Field& field, std::uint64_t count, bool dependent, std::uint64_t seed);

}  // namespace woodcock
