// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "woodcock/grid/motion.h"

namespace woodcock::grid {

/// Bounds of a field that moves: they hold at all times while the shutter is open. Found by
/// intervals in two steps, as the source of a position is: the velocities that a box may have tell
/// where the first look-up may lead, and those of that place where the second one may. So no
/// velocity is clamped, and nothing is cut off. Beyond Field::limits() the moved field is 0.
class MovedRanges {
public:
    /// Throws Error{Input} where there are too many voxels to be moved.
    MovedRanges(std::shared_ptr<const Field> field, std::shared_ptr<const Motion> motion);

    /// Index-space box outside of which the moved field is outside().
    const Box3d& support() const { return support_; }
    Range outside() const { return blocks_.outside(); }
    /// Of all blocks, as blockRanges() has them of a field that stands still.
    const BlockTable<Range>& blocks() const { return blocks_; }
    /// Of the 64 cells of 2^3 voxels in a block, x first.
    std::array<Range, 64> finest(Vec3i block) const;
    /// Of one channel, in a box of a few voxels along a ray: tight where the box is small.
    Range close(const Box3d& box, float time, int channel) const;
    /// Of the blocks that are not even, the part whose bounds had to look further than a block's
    /// width beyond it: velocities are large there, or differ much.
    double looseShare() const { return looseShare_; }

private:
    struct Cube;
    /// The voxels that interpolation reads there.
    Box3i tapsOf(const Box3d& sources) const;
    /// Whether what comes from there, of that range, is what is outside.
    bool isOutside(const Box3d& sources, Range range) const;
    Range rangeFrom(const Box3d& sources) const;
    /// The cubes that differ from what is outside, each of one level of a BlockTable.
    std::vector<Cube> differing() const;
    void place(const std::vector<Cube>& cubes);

    std::shared_ptr<const Field> field_;
    std::shared_ptr<const Motion> motion_;
    RangeTree tree_;
    Box3d reach_, support_;
    BlockTable<Range> blocks_;
    double looseShare_ = 0;
};

}  // namespace woodcock::grid
