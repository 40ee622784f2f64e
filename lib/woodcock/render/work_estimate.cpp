// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/work_estimate.h"

#include <algorithm>

namespace woodcock::render {

void WorkEstimate::begin(double samples, const std::vector<std::size_t>& paths) {
    now_ = samples, expected_ = done_ = 0;
    for (std::size_t i = 0; i < tiles_.size(); ++i) {
        Tile& tile = tiles_[i];
        tile.pathsNow = static_cast<double>(paths[i]);
        tile.expected = tile.pathsNow * (tile.paths > 0 ? tile.seconds / tile.paths : 1);
        expected_ += tile.expected;
    }
}

void WorkEstimate::finish(std::size_t i, double seconds) {
    Tile& tile = tiles_[i];
    tile.seconds += seconds, tile.paths += tile.pathsNow;
    done_ += tile.expected;
}

void WorkEstimate::end() { complete_ += now_, now_ = 0; }

double WorkEstimate::samplesDone() const {
    const double share = expected_ > 0 ? std::min(1.0, done_ / expected_) : 0;
    return complete_ + now_ * share;
}

}  // namespace woodcock::render
