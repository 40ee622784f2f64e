// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace woodcock::render {

/// Estimates how much of a render is done from the cost of its tiles so far. All samples of a pass
/// are assumed to cost the same, as SamplePlan plans them. Within a pass, each tile counts as much
/// as it cost before. Not thread-safe.
class WorkEstimate {
public:
    /// For a render of `samples` in each pixel. Does not throw.
    WorkEstimate(std::size_t tiles, double samples) : tiles_(tiles), samples_(samples) {}

    /// So many samples of each pixel were drawn before; call it first of all.
    void resumeAfter(double samples) { complete_ = samples; }
    /// A pass begins, of `samples` in each pixel; each tile traces so many `paths`.
    void begin(double samples, const std::vector<std::size_t>& paths);
    /// A tile of the pass is finished, after so many seconds of one thread.
    void finish(std::size_t tile, double seconds);
    /// All tiles of the pass are finished.
    void end();

    /// The work so far, as a number of samples in each pixel.
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

}  // namespace woodcock::render
