// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/formats/nanovdb.h"
#include "woodcock/base/error.h"

#ifdef WOODCOCK_WITH_NANOVDB
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <system_error>

#include "woodcock/base/whole_file.h"
#include "woodcock/grid/nanovdb/buffer.h"
#include "woodcock/grid/vdb/openvdb_grids.h"

namespace woodcock::convert {

namespace fs = std::filesystem;

namespace {

/// Checked here: NanoVDB would find these faults halfway, and leave the grid's nodes marked.
void requireWritable(const fs::path& file, const openvdb::GridBase& grid) {
    using namespace openvdb;
    const bool isScalar = grid.isType<FloatGrid>() || grid.isType<DoubleGrid>();
    if (!isScalar && !grid.isType<Vec3SGrid>())
        throw usageError("cannot write '{}': grid '{}' holds {}; expected float, double or vec3s",
                         file.string(), grid.getName(), grid.valueType());
    if (!isScalar && grid.getGridClass() == GRID_LEVEL_SET)
        throw usageError("cannot write '{}': level set '{}' holds vectors", file.string(),
                         grid.getName());
    if (!grid.transform().isLinear())
        throw usageError("cannot write '{}': the transform of grid '{}' is not affine",
                         file.string(), grid.getName());
}

nanovdb::io::Codec codecOf(NanoVdbCompression compression) {
    switch (compression) {
        case NanoVdbCompression::Zip:
            return nanovdb::io::Codec::ZIP;
        case NanoVdbCompression::Blosc:
            return nanovdb::io::Codec::BLOSC;
        case NanoVdbCompression::None:
            break;
    }
    return nanovdb::io::Codec::NONE;
}

using Handle = nanovdb::GridHandle<grid::NanoBuffer>;

template <class TreeT,
          class BuildT = typename nanovdb::OpenToNanoType<typename TreeT::BuildType>::Type>
Handle toNano(const openvdb::GridBase& base) {
    const auto& grid = static_cast<const openvdb::Grid<TreeT>&>(base);
    // No statistics for a tree without active voxels, about which NanoVDB would print a warning.
    // Minimum and maximum do not depend on the order of threads; averages would.
    const auto stats = grid.tree().activeVoxelCount() > 0 ? nanovdb::StatsMode::MinMax
                                                          : nanovdb::StatsMode::Disable;
    return nanovdb::openToNanoVDB<grid::NanoBuffer, TreeT, BuildT>(grid, stats,
                                                                   nanovdb::ChecksumMode::Full);
}

void measureLoss(const openvdb::FloatGrid& grid, const Handle& handle, NanoVdbLoss& most) {
    const auto access = handle.grid<nanovdb::Fp16>()->getAccessor();
    for (auto it = grid.cbeginValueOn(); it; ++it) {
        if (!it.isVoxelValue()) continue;  // tiles are kept as they are
        const openvdb::Coord at = it.getCoord();
        const auto exact = static_cast<double>(*it);
        const double error =
            std::abs(static_cast<double>(access.getValue({at.x(), at.y(), at.z()})) - exact);
        most.absolute = std::max(most.absolute, error);
        if (error > 0) most.relative = std::max(most.relative, error / std::abs(exact));
    }
}

Handle toNano(const openvdb::GridBase& grid, bool quantise, NanoVdbLoss& loss) {
    using namespace openvdb;
    if (grid.isType<Vec3SGrid>()) return toNano<Vec3STree>(grid);
    if (grid.isType<DoubleGrid>()) return toNano<DoubleTree>(grid);
    if (!quantise) return toNano<FloatTree>(grid);
    Handle handle = toNano<FloatTree, nanovdb::Fp16>(grid);
    measureLoss(static_cast<const FloatGrid&>(grid), handle, loss);
    return handle;
}

}  // namespace

NanoVdbLoss writeNanoVdb(const fs::path& file, const grid::VdbGrids& grids,
                         const NanoVdbWriteOptions& options) {
    if (grids.grids.empty())
        throw usageError("cannot write '{}': there are no grids", file.string());
    for (const openvdb::GridBase::Ptr& grid : grids.grids) requireWritable(file, *grid);
    NanoVdbLoss loss;
    FileInTheMaking making(file);
    errno = 0;
    try {
        std::ofstream out(making.temporary(), std::ios::binary);
        // A segment for each grid, so that only one grid at a time is in memory twice.
        for (const openvdb::GridBase::Ptr& grid : grids.grids)
            nanovdb::io::writeGrid(out, toNano(*grid, options.quantise, loss),
                                   codecOf(options.compression));
        out.close();
        if (!out) throw std::runtime_error("its end cannot be written");
    } catch (const std::exception& e) {
        const int reason = errno;
        throw failure("cannot write '{}': {}", file.string(),
                      reason ? std::generic_category().message(reason) : e.what());
    }
    making.commit();
    return loss;
}

}  // namespace woodcock::convert

#else

namespace woodcock::convert {

NanoVdbLoss writeNanoVdb(const std::filesystem::path& file, const grid::VdbGrids&,
                         const NanoVdbWriteOptions&) {
    throw failure(
        "cannot write '{}': this build has no NanoVDB; install libnanovdb-dev and configure again",
        file.string());
}

}  // namespace woodcock::convert

#endif
