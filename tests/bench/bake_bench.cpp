// SPDX-License-Identifier: Apache-2.0
// How fast recipes bake: bake_bench RECIPE.toml RESOLUTION [AX_CODE VDB_AX]
//
// Prints seconds, and million voxels a second, of a bake; of a loop over every voxel of the
// recipe's bounds; and, with code in OpenVDB AX that says the same, of a bake by an `ax` node of
// the recipe (see data/recipes/README.md) and of OpenVDB's own command-line tool upon a grid of the
// same active voxels, file input and output and start-up included.
#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>

#include "woodcock/bake/bake_file.h"
#include "woodcock/bake/baker.h"
#include "woodcock/bake/program.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace {

using namespace woodcock;
using namespace woodcock::bake;
using namespace woodcock::grid;

template <class Work>
double seconds(const Work& work) {
    double best = 1e30;
    for (int i = 0; i < 3; ++i) {
        const auto start = std::chrono::steady_clock::now();
        work();
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        best = std::min(best, time.count());
    }
    return best;
}

void print(const char* what, double time, double voxels) {
    fmt::print("{:<28} {:8.3f} s  {:8.2f} million voxels a second\n", what, time,
               voxels / time / 1e6);
}

/// All voxels, leaf by leaf and in parallel, into one array.
void denseLoop(const Recipe& recipe, double voxel) {
    const int roots[]{recipe.outputs[0].entry};
    const Program program(recipe.graph, roots);
    Vec3i first, size;
    for (int a = 0; a < 3; ++a) {
        first[a] = static_cast<int>(std::ceil(recipe.bounds.lower[a] / voxel));
        size[a] = static_cast<int>(std::floor(recipe.bounds.upper[a] / voxel)) - first[a] + 1;
    }
    std::vector<float> values(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                              static_cast<std::size_t>(size.z));
    tbb::parallel_for(0, (size.x + 7) / 8 * ((size.y + 7) / 8), [&](int row) {
        Program::Workspace work;
        std::vector<double> at[3];
        const int x0 = row % ((size.x + 7) / 8) * 8, y0 = row / ((size.x + 7) / 8) * 8;
        for (int z0 = 0; z0 < size.z; z0 += 8) {
            Points points;
            std::vector<std::size_t> places;
            for (auto& v : at) v.clear();
            for (int x = x0; x < std::min(x0 + 8, size.x); ++x)
                for (int y = y0; y < std::min(y0 + 8, size.y); ++y)
                    for (int z = z0; z < std::min(z0 + 8, size.z); ++z) {
                        const Vec3d p = (first + Vec3i{x, y, z}).as<double>() * voxel;
                        for (int a = 0; a < 3; ++a) at[a].push_back(p[a]);
                        points.box.add(p);
                        places.push_back(
                            (static_cast<std::size_t>(x) * static_cast<std::size_t>(size.y) +
                             static_cast<std::size_t>(y)) *
                                static_cast<std::size_t>(size.z) +
                            static_cast<std::size_t>(z));
                    }
            points.count = places.size();
            points.at = {at[0].data(), at[1].data(), at[2].data()};
            const Values v = program.evaluate(points, work)[0];
            for (std::size_t i = 0; i < places.size(); ++i)
                values[places[i]] = static_cast<float>(v.channel[0][i]);
        }
    });
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3 && argc != 5) {
        fmt::print(stderr, "usage: bake_bench RECIPE.toml RESOLUTION [AX_CODE VDB_AX]\n");
        return 2;
    }
    try {
        const Recipe recipe = makeRecipe(readRecipe(argv[1]), {});
        const Vec3d size = recipe.bounds.size();
        const double voxel = std::max({size.x, size.y, size.z}) / (std::atof(argv[2]) - 1);
        std::optional<Bake> bake;
        const double sparse = seconds([&] { bake = bakeRecipe(recipe, cubicVoxels(voxel)); });
        fmt::print("{:.3g} voxels in the box, {} evaluated, {} active\n", bake->boxVoxels,
                   bake->evaluatedVoxels, bake->statistics[0].activeVoxels);
        print("bake, of those evaluated", sparse, static_cast<double>(bake->evaluatedVoxels));
        print("bake, of the box", sparse, bake->boxVoxels);
        print("loop over the box", seconds([&] { denseLoop(recipe, voxel); }), bake->boxVoxels);
        if (argc == 5) {
            writeBake("bake_bench_in.vdb", *bake, {}, 0);
            const std::string command =
                fmt::format("{} -i bake_bench_in.vdb -o bake_bench_out.vdb -s '{}' > /dev/null",
                            argv[4], argv[3]);
            const double time = seconds([&] {
                if (std::system(command.c_str()) != 0) throw std::runtime_error(command);
            });
            print("vdb_ax, of the active", time,
                  static_cast<double>(bake->statistics[0].activeVoxels));
            std::remove("bake_bench_in.vdb"), std::remove("bake_bench_out.vdb");
        }
    } catch (const std::exception& e) {
        fmt::print(stderr, "bake_bench: {}\n", e.what());
        return 1;
    }
    return 0;
}
