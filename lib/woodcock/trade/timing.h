// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace woodcock::trade {

/// A number and its standard error.
struct Measured {
    double value = 0, se = 0;
};

/// Processor seconds that all threads of this process have taken so far. Unlike those of the wall
/// clock, they do not depend on other programs, except through caches and clock rates.
double processorSeconds();

/// Seconds of the wall clock since an arbitrary moment.
double wallSeconds();

/// The median and its error, by the median deviation: another program that runs during one of the
/// runs has no effect. Zero for no values; for one value the error is infinite (unknown).
Measured medianOf(std::vector<double> values);

}  // namespace woodcock::trade
