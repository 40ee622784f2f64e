// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/velocity.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <vector>

namespace woodcock::grid {

Velocity::Velocity(std::array<Source, 3> sources) : sources_(std::move(sources)) {
    for (std::size_t i = 0; i < 3; ++i)
        ranges_[i] = std::make_shared<RangeTree>(sources_[i].field, sources_[i].channel);
    fastest_ = findFastest();
}

Vec3d Velocity::background() const {
    Vec3d v;
    for (int i = 0; i < 3; ++i) v[i] = source(i).field->background(source(i).channel);
    return v;
}

bool Velocity::still() const {
    for (const Source& s : sources_)
        if (s.field->range() != Range{0, 0}) return false;
    return true;
}

Box3d Velocity::support() const {
    Box3d all;
    for (const Source& s : sources_) {
        const Box3d& box = s.field->support();
        if (!box.empty())
            all.add(s.objectFromIndex.box({box.lower + s.offset, box.upper + s.offset}));
    }
    return all;
}

Velocity::Fastest Velocity::findFastest() const {
    std::vector<Vec3i> blocks;
    for (std::size_t i = 0; i < 3; ++i) {
        const bool again = i > 0 && sources_[i].field == sources_[i - 1].field;
        if (again) continue;
        const auto& table = sources_[i].field->blocks();
        table.forEach([&](Vec3i b, int, std::uint32_t ref) {
            if (ref != table.outside()) blocks.push_back(b);  // the first one of a tile
        });
    }
    const auto faster = [](const Fastest& a, const Fastest& b) {
        return length(b.velocity) > length(a.velocity) ? b : a;
    };
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, blocks.size(), 64), Fastest{background(), {}},
        [&](const tbb::blocked_range<std::size_t>& part, Fastest most) {
            for (std::size_t k = part.begin(); k != part.end(); ++k) {
                const Vec3i b = blocks[k];
                std::array<std::optional<Field::BlockVoxels>, 3> voxels;
                for (std::size_t i = 0; i < 3; ++i) voxels[i].emplace(*sources_[i].field, b);
                for (int j = 0; j < 512; ++j) {
                    const Vec3i v = b * 8 + Vec3i{j >> 6, j >> 3 & 7, j & 7};
                    Vec3d velocity;
                    for (int i = 0; i < 3; ++i)
                        velocity[i] = (*voxels[index(i)])(v, source(i).channel);
                    most = faster(most, {velocity, v});
                }
            }
            return most;
        },
        faster);
}

}  // namespace woodcock::grid
