// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/askable.h"

#include <algorithm>
#include <cmath>

namespace woodcock::trade {
namespace {

/// The double nearest to digits x 10^power, as a reader of that decimal number gets it.
double decimal(int digits, int power) {
    const double scale = std::pow(10, std::abs(power));
    return power < 0 ? digits / scale : digits * scale;
}

int decadeOf(double v) { return static_cast<int>(std::floor(std::log10(v))); }

enum class To { Lower, Higher };
/// The next number of two digits; the number itself where it has no more.
double twoDigits(double v, To to) {
    constexpr double rounding = 1e-9;  // of the decimal number's last bits
    const int power = decadeOf(v) - 1;
    const double digits = v / decimal(1, power);
    return decimal(static_cast<int>(to == To::Lower ? std::floor(digits + rounding)
                                                    : std::ceil(digits - rounding)),
                   power);
}

std::vector<double> positive(const std::vector<double>& numbers) {
    std::vector<double> kept;
    for (const double v : numbers)
        if (std::isfinite(v) && v > 0) kept.push_back(v);
    return kept;
}

}  // namespace

Range sensibleTimes(const TradeResult& result, double budget) {
    std::vector<double> firsts, lasts{budget};
    for (const CandidateResult& c : result.candidates) {
        firsts.push_back(c.model.firstSample());
        for (const TradePoint& point : c.points) lasts.push_back(point.seconds);
    }
    for (const TradeReading& reading : result.equalTime) lasts.push_back(reading.target);
    firsts = positive(firsts);
    const double last = std::ranges::max(lasts);
    const double first = firsts.empty() ? last : std::min(last, std::ranges::min(firsts));
    return {twoDigits(first, To::Higher), twoDigits(last, To::Higher)};
}

Range sensibleErrors(const TradeResult& result, Range times) {
    constexpr double largest = 1;
    const std::vector<TradeModel> models = result.models();
    std::vector<double> errors;
    for (const double seconds : {times.low, times.high})
        if (const auto winner = bestAt(models, seconds))
            errors.push_back(models[winner->best].errorAt(seconds)->value);
    for (const TradeReading& reading : result.equalError) errors.push_back(reading.target);
    errors = positive(errors);
    if (errors.empty()) return {1e-4, largest};  // there is no noise, and any will do
    const auto [low, high] = std::ranges::minmax(errors);
    return {twoDigits(low, To::Lower),
            twoDigits(low < largest ? std::min(high, largest) : high, To::Higher)};
}

std::vector<double> roundNumbers(Range fine, Range coarse) {
    const double low = std::min(fine.low, coarse.low), high = std::max(fine.high, coarse.high);
    std::vector<double> numbers;
    for (int decade = decadeOf(low); decade <= decadeOf(high); ++decade)
        for (int digits = 10; digits < 100; ++digits) {
            const double v = decimal(digits, decade - 1);
            const Range& range = digits % 10 == 0 ? Range{low, high} : fine;
            if (v >= range.low && v <= range.high) numbers.push_back(v);
        }
    return numbers;
}

}  // namespace woodcock::trade
