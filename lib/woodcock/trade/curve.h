// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "woodcock/trade/timing.h"

namespace woodcock::trade {

/// A measured cost at one place.
struct CurvePoint {
    double x = 0, y = 0, se = 0;
};

/// The exponent of the power of x that fits the points best: least squares of log y over log x,
/// with equal weights, as none of these curves is a power law throughout. Its error follows from
/// the scatter about that line, or from the points' own errors, whichever is larger. Points that
/// are not positive are left out. With fewer than two different x the slope is 0 with an infinite
/// error.
Measured fitSlope(const std::vector<CurvePoint>& points);

struct CurveSeries {
    std::string name;
    std::vector<CurvePoint> points;

    Measured slope() const { return fitSlope(points); }
};

/// A curve of measured costs.
struct Curve {
    std::string name, xLabel, yLabel, note;
    std::vector<CurveSeries> series;
};

struct CurveTable {
    std::string title;
    std::vector<std::string> columns;
    std::vector<std::vector<double>> rows;
};

}  // namespace woodcock::trade
