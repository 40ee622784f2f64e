// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace woodcock::trade {

Measured fitSlope(const std::vector<CurvePoint>& points) {
    struct Logs {
        double x, y, se;
    };
    std::vector<Logs> logs;
    double meanX = 0, meanY = 0;
    for (const CurvePoint& p : points) {
        if (!(p.x > 0) || !(p.y > 0)) continue;
        logs.push_back({std::log(p.x), std::log(p.y), p.se / p.y});
        meanX += logs.back().x, meanY += logs.back().y;
    }
    const double n = static_cast<double>(logs.size());
    meanX /= n, meanY /= n;
    double xx = 0, xy = 0;
    for (const Logs& l : logs) {
        xx += (l.x - meanX) * (l.x - meanX);
        xy += (l.x - meanX) * (l.y - meanY);
    }
    if (!(xx > 0)) return {0, std::numeric_limits<double>::infinity()};
    const double slope = xy / xx;
    double scatter = 0, own = 0;
    for (const Logs& l : logs) {
        const double residual = l.y - meanY - slope * (l.x - meanX);
        scatter += residual * residual;
        own += (l.x - meanX) * (l.x - meanX) * l.se * l.se;
    }
    const double byScatter = n > 2 ? std::sqrt(scatter / (n - 2) / xx) : 0;
    return {slope, std::max(byScatter, std::sqrt(own) / xx)};
}

}  // namespace woodcock::trade
