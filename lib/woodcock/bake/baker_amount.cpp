// SPDX-License-Identifier: Apache-2.0
// Estimates the amount of work of a bake beforehand.
#include <cmath>
#include <tuple>

#include "woodcock/bake/openvdb_baker.h"

namespace woodcock::bake {

Error Baker::tooMuch(double voxels) const {
    // Varying voxels grow like surfaces: a factor of two in size is one of four in voxels.
    const double factor = std::max(std::sqrt(voxels / settings_.mostVoxels), 1.1);
    return inputError(
        "the recipe would be evaluated at about {:.2g} voxels; the limit is {:.2g}. Make voxels "
        "{:.2g} times as large, or raise the limit with --max-voxels",
        voxels, settings_.mostVoxels, factor);
}

/// About how many voxels vary, from the number of regions of a size that is coarse enough to count:
/// a surface crosses (size / 8)^2 leaves of each.
double Baker::guessVoxels() {
    constexpr std::uint64_t affordable = 20'000;
    const std::vector<Region> roots = rootRegions();
    for (int size = 2 * pieceSize;; size *= 2) {
        std::atomic<std::uint64_t> count{0};
        stopped_ = false;
        const auto visit = [&](const Region&, const std::vector<Status>& status,
                               const std::vector<Bounds>&, Worker&) {
            if (any(status, Status::Varying) && ++count > affordable) stopped_ = true;
        };
        tbb::parallel_for(std::size_t{0}, roots.size(), [&](std::size_t i) {
            descend(roots[i], std::min(size, roots[i].size), visit);
        });
        if (!stopped_ || size >= roots.front().size)
            return 512.0 * static_cast<double>(count) * std::pow(size / 8.0, 2);
    }
}

/// Fills regions that are constant on a coarse scale, and lists the others.
void Baker::findPieces() {
    constexpr std::size_t most = 300'000;
    std::atomic<std::size_t> count{0};
    const std::vector<Region> roots = rootRegions();
    const auto visit = [&](const Region& region, const std::vector<Status>& status,
                           const std::vector<Bounds>& bounds, Worker& mine) {
        if (!any(status, Status::Varying)) return fillRegion(region, status, bounds, mine);
        mine.pieces.push_back(region);
        if (++count > most) stopped_ = true;
    };
    tbb::parallel_for(std::size_t{0}, roots.size(),
                      [&](std::size_t i) { descend(roots[i], pieceSize, visit); });
    if (stopped_) throw tooMuch(std::max(guessVoxels(), settings_.mostVoxels));
    for (Worker& worker : workers_)
        pieces_.insert(pieces_.end(), worker.pieces.begin(), worker.pieces.end());
    std::sort(pieces_.begin(), pieces_.end(), [](const Region& a, const Region& b) {
        return std::tie(a.origin.x, a.origin.y, a.origin.z) <
               std::tie(b.origin.x, b.origin.y, b.origin.z);
    });
}

/// Counts the leaves of some of the pieces, to know about how many there are in all.
void Baker::checkAmount() {
    if (static_cast<double>(pieces_.size()) * std::pow(pieceSize, 3) <= settings_.mostVoxels)
        return;
    const std::size_t step = std::max<std::size_t>(1, pieces_.size() / 200);
    const std::size_t samples = (pieces_.size() + step - 1) / step;
    std::atomic<std::uint64_t> leaves{0};
    const auto visit = [&](const Region&, const std::vector<Status>& status,
                           const std::vector<Bounds>&, Worker&) {
        if (any(status, Status::Varying)) ++leaves;
    };
    tbb::parallel_for(std::size_t{0}, samples,
                      [&](std::size_t i) { descend(pieces_[i * step], 8, visit); });
    const double voxels = 512 * static_cast<double>(leaves) * static_cast<double>(pieces_.size()) /
                          static_cast<double>(samples);
    if (voxels > settings_.mostVoxels) throw tooMuch(voxels);
}

}  // namespace woodcock::bake
