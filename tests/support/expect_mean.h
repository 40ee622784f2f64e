// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "woodcock/base/statistics.h"

namespace woodcock::test {

/// The mean must lie within four standard errors of `expected` (and a millionth, for the rounding
/// of floats), and the standard error be no more than `largestError`, so that passing means
/// something.
void expectMean(const Moments& samples, double expected, double largestError,
                const std::string& what);

}  // namespace woodcock::test
