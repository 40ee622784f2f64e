// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "woodcock/trade/trade.h"

namespace woodcock::trade {

// The times and the errors for which a report holds answers. They are numbers as people say them,
// of two digits where it matters and of one digit beyond, so that a time that is asked for is, as a
// rule, among them.

struct Range {
    double low = 0, high = 0;
};

/// Seconds that tell candidates apart, as numbers of two digits: from the first sample of any to
/// `budget`, the last point that was measured or the last equal time, whichever is latest.
Range sensibleTimes(const TradeResult& result, double budget);

/// Errors likewise: from the least that is reached in `times`, or the least equal error, to the
/// largest. That is at most 1, beyond which there is no picture, unless all errors are larger.
Range sensibleErrors(const TradeResult& result, Range times);

/// All numbers of two digits in `fine`, and all of one digit in `coarse`, ascending. The ends are
/// positive; those of `fine` have two digits.
std::vector<double> roundNumbers(Range fine, Range coarse);

}  // namespace woodcock::trade
