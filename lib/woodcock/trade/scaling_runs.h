// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "woodcock/render/session.h"
#include "woodcock/trade/timing.h"

namespace woodcock::trade {

/// A render whose samples are timed.
struct TimedRender {
    render::Scene scene;
    std::string name;  ///< for notes
    double x = 0;      ///< its position on the curve
    int threads = 1;
    bool wallClock = false;  ///< else processor time

    // Set by timeRenders(); microseconds stay 0 where there was not enough time:
    Measured microseconds = {};  ///< of one sample of one pixel
    render::RenderCounters counters = {};
    double seconds = 0;  ///< that all counted runs took, by its clock

    double perSample(std::uint64_t count) const {
        return static_cast<double>(count) / static_cast<double>(counters.paths);
    }
    double collisions() const {
        return static_cast<double>(counters.distanceCollisions + counters.shadowCollisions);
    }
};

/// Runs all of them alternately for about so many seconds of wall clock, each round with other
/// random numbers. Notes tell which were left out because they take too long.
void timeRenders(std::vector<TimedRender>& renders, double seconds,
                 std::vector<std::string>& notes);

}  // namespace woodcock::trade
