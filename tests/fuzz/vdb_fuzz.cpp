// SPDX-License-Identifier: Apache-2.0
// Input: a VDB file. Every grid is loaded, as a field with its majorants.
#include <tbb/global_control.h>

#include <cstdint>

#include "tests/fuzz/memory_file.h"
#include "woodcock/base/error.h"
#include "woodcock/grid/majorants.h"
#include "woodcock/grid/vdb/load_field.h"

namespace {

using namespace woodcock;

void load(const grid::VdbFile& file, const grid::GridListing& grid) {
    const grid::LoadedGrid loaded =
        grid::loadGrid(file, grid, {.use = grid::GridUse::Colour, .repair = true});
    grid::majorantStatistics(loaded.field, grid::MajorantGrid(loaded.field, {}), 16);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // One thread, so that the same input always takes the same path.
    static const tbb::global_control serial(tbb::global_control::max_allowed_parallelism, 1);
    const test::MemoryFile input(data, size);
    try {
        const grid::VdbFile file = grid::listGrids(input.path());
        for (const grid::GridListing& grid : file.grids) {
            try {
                load(file, grid);
            } catch (const Error&) {  // the next grid may be sound
            }
        }
    } catch (const Error&) {
    }
    return 0;
}
