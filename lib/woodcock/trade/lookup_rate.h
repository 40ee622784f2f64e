// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "woodcock/grid/field.h"

namespace woodcock::trade {

/// A cube of about so many bricks, all of which vary: a field without empty space.
grid::Field fieldOfBricks(std::size_t bricks);

/// Reads a field at `count` random points of its support, by one tap of stochastic interpolation as
/// the trackers do, and returns the sum of the values. `dependent`: each point depends on the value
/// before it, so a lookup has to end before the next begins; else many may run at once. These are
/// the machine's limits for a path tracer.
double lookAtRandom(const grid::Field& field, std::uint64_t count, bool dependent,
                    std::uint64_t seed);

}  // namespace woodcock::trade
