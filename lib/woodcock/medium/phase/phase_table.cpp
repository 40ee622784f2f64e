// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/phase/phase_table.h"

#include <charconv>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include "woodcock/base/error.h"

namespace woodcock::medium {

namespace {

void checkCosines(const std::vector<double>& cosines) {
    if (cosines.size() < 2)
        throw inputError("the table has {} rows; at least two are needed, for the cosines -1 and 1",
                         cosines.size());
    for (std::size_t i = 0; i + 1 < cosines.size(); ++i)
        if (!(cosines[i] < cosines[i + 1]))
            throw inputError("the cosines do not rise: {} comes after {}", cosines[i + 1],
                             cosines[i]);
    if (cosines.front() != -1 || cosines.back() != 1)
        throw inputError("the cosines reach from {} to {}; they must reach from -1 to 1",
                         cosines.front(), cosines.back());
}

}  // namespace

PhaseTable::PhaseTable(const Columns& columns, bool normalise) {
    checkCosines(columns.cosines);
    const std::vector<double>& c = columns.cosines;
    const std::size_t rows = c.size();
    if (columns.densities.size() != 1 && columns.densities.size() != 3)
        throw inputError("the table has {} columns of densities; expected one, or three for colour",
                         columns.densities.size());
    for (const std::vector<double>& densities : columns.densities) {
        if (densities.size() != rows)
            throw inputError("the table has {} cosines and {} densities", rows, densities.size());
        Column column{.cosines = c, .densities = densities, .cdf = {0}};
        for (std::size_t i = 0; i < rows; ++i)
            if (!(densities[i] >= 0 && std::isfinite(densities[i])))
                throw inputError(
                    "the density at the cosine {} is {}; expected a finite number >= 0", c[i],
                    densities[i]);
        for (std::size_t i = 0; i + 1 < rows; ++i)
            column.cdf.push_back(column.cdf.back() +
                                 pi * (c[i + 1] - c[i]) * (densities[i] + densities[i + 1]));
        const double integral = column.cdf.back();
        if (!(integral > 0 && std::isfinite(integral)))
            throw inputError("the phase function's integral over the sphere is {}", integral);
        if (!normalise && std::abs(integral - 1) > integralTolerance)
            throw inputError(
                "the phase function's integral over the sphere is {:.6g}; it must be 1, or the key "
                "normalise must be true",
                integral);
        for (double& d : column.densities) d /= integral;
        for (double& part : column.cdf) part /= integral;
        for (std::size_t i = 0; i + 1 < rows; ++i) {
            const double a = column.densities[i], b = column.densities[i + 1];
            column.meanCosine += pi / 3 * (c[i + 1] - c[i]) *
                                 (a * (2 * c[i] + c[i + 1]) + b * (c[i] + 2 * c[i + 1]));
        }
        columns_.push_back(std::move(column));
    }
}

double PhaseTable::Column::value(double cosine) const {
    const auto above = std::upper_bound(cosines.begin() + 1, cosines.end() - 1, cosine);
    const auto i = static_cast<std::size_t>(above - cosines.begin());
    const double part = (cosine - cosines[i - 1]) / (cosines[i] - cosines[i - 1]);
    return densities[i - 1] + std::clamp(part, 0.0, 1.0) * (densities[i] - densities[i - 1]);
}

Turn PhaseTable::Column::sample(double u) const {
    // The last row whose part lies at u or below: the interval above it is not empty.
    const auto above = std::upper_bound(cdf.begin() + 1, cdf.end() - 1, u);
    const auto i = static_cast<std::size_t>(above - cdf.begin());
    const double a = densities[i - 1], b = densities[i], width = cosines[i] - cosines[i - 1];
    const double within = std::clamp((u - cdf[i - 1]) / (cdf[i] - cdf[i - 1]), 0.0, 1.0);
    // The CDF of a straight line, inverted; written so that a may equal b.
    const double root = a + std::sqrt(a * a + within * (b * b - a * a));
    const double part = root > 0 ? std::min(within * (a + b) / root, 1.0) : 0;
    return {(1 - cosines[i - 1]) - part * width, (1 + cosines[i - 1]) + part * width};
}

double PhaseTable::value(double cosine, int channel) const { return column(channel).value(cosine); }

double PhaseTable::value(double cosine) const {
    double sum = 0;
    for (const Column& column : columns_) sum += column.value(cosine);
    return sum / static_cast<double>(columns_.size());
}

Turn PhaseTable::sample(double u, int channel) const { return column(channel).sample(u); }

Turn PhaseTable::sample(double u) const {
    if (!chromatic()) return sample(u, 0);
    const int channel = std::min(static_cast<int>(3 * u), 2);
    return sample(3 * u - channel, channel);
}

double PhaseTable::meanCosine(int channel) const { return column(channel).meanCosine; }

double PhaseTable::meanCosine() const {
    double sum = 0;
    for (const Column& column : columns_) sum += column.meanCosine;
    return sum / static_cast<double>(columns_.size());
}

namespace {

/// The numbers of a line; null where something else stands there.
std::optional<std::vector<double>> numbersOf(std::string_view line) {
    constexpr std::string_view between = " \t\r,";
    line = line.substr(0, line.find('#'));
    std::vector<double> numbers;
    while (true) {
        const std::size_t start = line.find_first_not_of(between);
        if (start == std::string_view::npos) return numbers;
        line.remove_prefix(start);
        if (line.front() == '+') line.remove_prefix(1);
        double number = 0;
        const char* const end = line.data() + line.size();
        const auto [stop, error] = std::from_chars(line.data(), end, number);
        if (error != std::errc() ||
            (stop != end && between.find(*stop) == std::string_view::npos) ||
            !std::isfinite(number))
            return {};
        numbers.push_back(number);
        line.remove_prefix(static_cast<std::size_t>(stop - line.data()));
    }
}

}  // namespace

PhaseTable readPhaseTable(const std::filesystem::path& file, bool normalise) {
    constexpr std::uintmax_t largestFile = 64 << 20, largestLine = 4096;
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (error)
        throw inputError("cannot read the phase function's table {}: {}", file.string(),
                         error.message());
    if (size > largestFile)
        throw inputError("{}: {} bytes are too many for a phase function's table", file.string(),
                         size);
    std::ifstream in(file);
    if (!in) throw inputError("cannot read the phase function's table {}", file.string());
    PhaseTable::Columns columns;
    std::size_t number = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        const auto row = line.size() > largestLine ? std::nullopt : numbersOf(line);
        if (row && row->empty()) continue;
        const std::size_t expected = columns.densities.size();
        if (!row || (row->size() != 2 && row->size() != 4) ||
            (expected > 0 && row->size() != expected + 1))
            throw inputError("{}:{}: expected a cosine and {}", file.string(), number,
                             expected == 1 ? "one density, as in the rows before"
                             : expected == 3
                                 ? "three densities, as in the rows before"
                                 : "one density per steradian, or three for red, green and blue");
        columns.densities.resize(row->size() - 1);
        columns.cosines.push_back((*row)[0]);
        for (std::size_t i = 1; i < row->size(); ++i) columns.densities[i - 1].push_back((*row)[i]);
    }
    if (in.bad()) throw inputError("{}: reading failed", file.string());
    try {
        return PhaseTable(columns, normalise);
    } catch (const Error& e) {
        throw Error(e.kind(), file.string() + ": " + e.what());
    }
}

}  // namespace woodcock::medium
