// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "woodcock/base/spectrum.h"
#include "woodcock/medium/phase/turn.h"

namespace woodcock::medium {

/// A phase function by numbers: linear in the cosine between those that are given. One column, or
/// one for each colour channel.
class PhaseTable {
public:
    static constexpr const char* name = "table";

    struct Columns {
        std::vector<double> cosines;                 ///< rising, from -1 to 1
        std::vector<std::vector<double>> densities;  ///< one or three, per steradian
    };
    /// The part by which a column's integral over the sphere may differ from 1: what rounding and
    /// straight lines between the rows leave. It is divided out.
    static constexpr double integralTolerance = 1e-3;

    /// `normalise`: whatever the integral is, it is divided out. Throws Error{Input} where a number
    /// is not finite, cosines do not rise or do not reach from -1 to 1, a density is negative, or
    /// an integral is not 1.
    explicit PhaseTable(const Columns& columns, bool normalise = false);

    bool chromatic() const { return columns_.size() == 3; }
    /// The mean of the channels.
    double value(double cosine) const;
    double value(double cosine, int channel) const;
    /// By the mean of the channels.
    Turn sample(double u) const;
    Turn sample(double u, int channel) const;
    double meanCosine() const;
    double meanCosine(int channel) const;

private:
    struct Column {
        std::vector<double> cosines, densities;
        std::vector<double> cdf;  ///< the part of light below each cosine
        double meanCosine = 0;

        double value(double cosine) const;
        Turn sample(double u) const;
    };
    const Column& column(int channel) const {
        return columns_[chromatic() ? static_cast<std::size_t>(channel) : 0];
    }
    std::vector<Column> columns_;
};

/// Reads a table from text: a row for each cosine, with the cosine and one density or three, apart
/// by spaces, tabs or a comma. What follows # is not read. Throws Error{Input} with file and line
/// where that is not so, and with the file where PhaseTable refuses it.
PhaseTable readPhaseTable(const std::filesystem::path& file, bool normalise = false);

}  // namespace woodcock::medium
