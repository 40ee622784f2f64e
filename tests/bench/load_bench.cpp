// SPDX-License-Identifier: Apache-2.0
// How long loading a grid takes, beside OpenVDB's own reading of it.
// usage: load_bench FILE.vdb GRID [REPEATS]

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "woodcock/base/error.h"
#include "woodcock/grid/vdb/load_field.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace {

/// Seconds of the quickest of `repeats` runs: the one that least else disturbed.
template <class F>
double best(int repeats, F&& run) {
    double seconds = std::numeric_limits<double>::infinity();
    for (int i = 0; i < repeats; ++i) {
        const auto start = std::chrono::steady_clock::now();
        run();
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
        seconds = std::min(seconds, taken.count());
    }
    return seconds;
}

}  // namespace

int main(int count, char** words) {
    if (count < 3) {
        std::fprintf(stderr, "usage: %s FILE.vdb GRID [REPEATS]\n", words[0]);
        return 2;
    }
    const char *file = words[1], *grid = words[2];
    const int repeats = count > 3 ? std::max(1, std::atoi(words[3])) : 10;
    try {
        openvdb::initialize();
        const double reading = best(repeats, [&] {
            openvdb::io::File in(file);
            in.open(/*delayLoad=*/false);
            in.readGrid(grid);
        });
        const double loading = best(repeats, [&] { woodcock::grid::loadGrid(file, grid); });
        std::printf("OpenVDB reads %.4f s   woodcock loads %.4f s   ratio %.2f   (best of %d)\n",
                    reading, loading, loading / reading, repeats);
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
}
