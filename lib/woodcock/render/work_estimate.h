// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace woodcock {

/// How much of a render is done, by what its tiles have cost so far. All samples of a pass over the
/// picture are taken to cost alike, as SamplePlan makes them; within a pass, tiles count as much as
/// they cost before. Not for several threads at once.
class WorkEstimate {
public:
    /// Of a render of `samples` for each pixel. Throws nothing.
    WorkEstimate(std::size_t tiles, double samples) : tiles_(tiles), samples_(samples) {}

    /// A pass of so many samples for each pixel begins, in which each tile traces so many paths.
    void begin(double samples, const std::vector<std::size_t>& paths);
    /// A tile of it is ready, after so many seconds of one thread.
    void finish(std::size_t tile, double seconds);
    /// All of its tiles are.
    void end();

    /// Samples for each pixel that the work so far stands for.
    double samplesDone() const;
    double fraction() const { return samplesDone() / samples_; }  ///< of all, 0 to 1

private:
    struct Tile {
        double seconds = 0, paths = 0;  ///< of all passes so far
        double pathsNow = 0, expected = 0;
    };
    std::vector<Tile> tiles_;
    double samples_, complete_ = 0, now_ = 0;
    double expected_ = 0, done_ = 0;  ///< of this pass, in seconds or, in the first one, paths
};

}  // namespace woodcock
