// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "woodcock/base/statistics.h"

namespace woodcock::proof {

/// A mean and its standard error.
struct Estimate {
    double mean = 0, error = 0;
    Estimate() = default;
    Estimate(double m, double e) : mean(m), error(e) {}
    explicit Estimate(const Moments& m) : mean(m.mean()), error(m.standardError()) {}
};
using RgbEstimate = std::array<Estimate, 3>;

}  // namespace woodcock::proof
