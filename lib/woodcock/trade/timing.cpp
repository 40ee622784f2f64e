// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/timing.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace woodcock::trade {
namespace {

double secondsOf(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2) return *middle;
    return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

}  // namespace

double processorSeconds() { return secondsOf(CLOCK_PROCESS_CPUTIME_ID); }
double wallSeconds() { return secondsOf(CLOCK_MONOTONIC); }

Measured medianOf(std::vector<double> values) {
    if (values.empty()) return {};
    const double n = static_cast<double>(values.size());
    const double middle = median(values);
    if (values.size() < 2) return {middle, std::numeric_limits<double>::infinity()};
    for (double& v : values) v = std::abs(v - middle);
    // For normal numbers, sigma is 1.4826 median deviations, and the median's error is sqrt(pi / 2)
    // sigma / sqrt(n). Few values deviate less from their own median, so n - 1.
    return {middle, 1.2533 * 1.4826 * median(values) / std::sqrt(n - 1)};
}

}  // namespace woodcock::trade
