// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "woodcock/base/statistics.h"
#include "woodcock/proof/proof.h"

namespace woodcock::proof {

/// Counts samples in cells, for a chi-square test.
class Cells {
public:
    /// `rows` x `columns` cells of even shares over [0, 1)^2.
    Cells(int rows, int columns);
    /// The same with given shares, row by row.
    Cells(int rows, int columns, std::vector<double> shares);

    void add(double row, double column = 0);
    /// The statistic as a normal deviate; 0 is expected.
    Case asCase(std::string name) const;

private:
    int rows_, columns_;
    std::vector<double> shares_, counts_;
    double count_ = 0;
};

Case meanCase(std::string name, double expected, const Moments& samples, double largestError);

/// A case without randomness: `measured` must be `expected`, up to `allowance`.
Case exactCase(std::string name, double expected, double measured, double allowance,
               std::string note = "rounding");

}  // namespace woodcock::proof
