// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace woodcock {

/// Mean and standard error of a stream of numbers. Welford 1962: accurate where sums of squares
/// would lose all digits.
class Moments {
public:
    void add(double x) {
        ++count_;
        const double d = x - mean_;
        mean_ += d / static_cast<double>(count_);
        squares_ += d * (x - mean_);
    }
    std::uint64_t count() const { return count_; }
    double mean() const { return mean_; }
    double variance() const {  ///< unbiased; 0 for fewer than two numbers
        return count_ > 1 ? squares_ / static_cast<double>(count_ - 1) : 0;
    }
    double standardError() const {
        return count_ > 1 ? std::sqrt(variance() / static_cast<double>(count_)) : 0;
    }

private:
    std::uint64_t count_ = 0;
    double mean_ = 0, squares_ = 0;
};

}  // namespace woodcock
