// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/checks/cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "woodcock/proof/support/statistics.h"

namespace woodcock::proof {

Cells::Cells(int rows, int columns)
    : Cells(rows, columns,
            std::vector<double>(static_cast<std::size_t>(rows * columns), 1.0 / (rows * columns))) {
}

Cells::Cells(int rows, int columns, std::vector<double> shares)
    : rows_(rows), columns_(columns), shares_(std::move(shares)), counts_(shares_.size()) {}

void Cells::add(double row, double column) {
    const auto cell = [](double u, int n) { return std::clamp(static_cast<int>(u * n), 0, n - 1); };
    ++counts_[static_cast<std::size_t>(cell(row, rows_) * columns_ + cell(column, columns_))];
    ++count_;
}

Case Cells::asCase(std::string name) const {
    std::vector<double> expected;
    for (const double share : shares_) expected.push_back(share * count_);
    return {
        .name = std::move(name) + ", chi-square",
        .expected = 0,
        .measured = chiSquareDeviate(counts_, expected),
        .standardError = 1,
        .largestError = 1,
        .note = fmt::format("as a normal deviate; {} samples in {} cells", count_, counts_.size())};
}

Case meanCase(std::string name, double expected, const Moments& samples, double largestError) {
    return {.name = std::move(name),
            .expected = expected,
            .measured = samples.mean(),
            .standardError = samples.standardError(),
            .largestError = largestError,
            .allowance = 2e-6 * std::abs(expected)};
}

Case exactCase(std::string name, double expected, double measured, double allowance,
               std::string note) {
    return {.name = std::move(name),
            .expected = expected,
            .measured = measured,
            .allowance = allowance,
            .note = std::move(note)};
}

}  // namespace woodcock::proof
