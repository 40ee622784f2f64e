// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace woodcock {

/// A number and its standard error.
struct Measured {
    double value = 0, se = 0;
};

/// Processor seconds that all threads of this process have taken so far. Unlike the wall clock's,
/// they say the same beside other programs, but for what those do to caches and clock rates.
double processorSeconds();

/// Wall clock, seconds since some moment.
double wallSeconds();

/// The median and its error, by the median deviation: a program that wakes up in the midst of one
/// of the runs does not show. All zero for no values; of one value the error is unknown: infinite.
Measured medianOf(std::vector<double> values);

}  // namespace woodcock
