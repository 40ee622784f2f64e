// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/nanovdb_file.h"
#include "woodcock/base/error.h"

#ifdef WOODCOCK_WITH_NANOVDB
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>

#include <cerrno>
#include <fstream>
#include <system_error>

#include "woodcock/convert/nanovdb_buffer.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/grid/openvdb_grids.h"

namespace woodcock {

namespace fs = std::filesystem;

namespace {

/// NanoVDB would find these faults halfway, and leave the grid's nodes marked.
void requireWritable(const fs::path& file, const openvdb::GridBase& grid) {
    const bool isFloat = grid.isType<openvdb::FloatGrid>();
    if (!isFloat && !grid.isType<openvdb::Vec3SGrid>())
        throw usageError("cannot write '{}': grid '{}' holds {} where float or vec3s is expected",
                         file.string(), grid.getName(), grid.valueType());
    if (!isFloat && grid.getGridClass() == openvdb::GRID_LEVEL_SET)
        throw usageError("cannot write '{}': level set '{}' holds vectors", file.string(),
                         grid.getName());
    if (!grid.transform().isLinear())
        throw usageError("cannot write '{}': the transform of grid '{}' is not affine",
                         file.string(), grid.getName());
}

template <class TreeT>
void append(std::ostream& out, const openvdb::GridBase& base) {
    const auto& grid = static_cast<const openvdb::Grid<TreeT>&>(base);
    // Of a tree without active voxels NanoVDB could only warn, on the terminal. The minimum and
    // maximum do not depend on the order in which threads find them, averages would.
    const auto stats = grid.tree().activeVoxelCount() > 0 ? nanovdb::StatsMode::MinMax
                                                          : nanovdb::StatsMode::Disable;
    nanovdb::io::writeGrid(
        out, nanovdb::openToNanoVDB<NanoBuffer, TreeT>(grid, stats, nanovdb::ChecksumMode::Full));
}

}  // namespace

bool hasNanoVdb() { return true; }

void writeNanoVdb(const fs::path& file, const VdbGrids& grids) {
    if (grids.grids.empty())
        throw usageError("cannot write '{}': there are no grids", file.string());
    for (const openvdb::GridBase::Ptr& grid : grids.grids) requireWritable(file, *grid);
    FileInTheMaking making(file);
    errno = 0;
    try {
        std::ofstream out(making.temporary(), std::ios::binary);
        // A segment for each, so that one grid at a time is in memory twice.
        for (const openvdb::GridBase::Ptr& grid : grids.grids)
            if (grid->isType<openvdb::FloatGrid>())
                append<openvdb::FloatTree>(out, *grid);
            else
                append<openvdb::Vec3STree>(out, *grid);
        out.close();
        if (!out) throw std::runtime_error("its end cannot be written");
    } catch (const std::exception& e) {
        const int reason = errno;
        throw failure("cannot write '{}': {}", file.string(),
                      reason ? std::generic_category().message(reason) : e.what());
    }
    making.commit();
}

}  // namespace woodcock

#else

namespace woodcock {

bool hasNanoVdb() { return false; }

void writeNanoVdb(const std::filesystem::path& file, const VdbGrids&) {
    throw failure(
        "cannot write '{}': this build has no NanoVDB; install libnanovdb-dev and configure again",
        file.string());
}

}  // namespace woodcock

#endif
