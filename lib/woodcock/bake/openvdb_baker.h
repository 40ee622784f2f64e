// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <mutex>

#include "woodcock/bake/openvdb_bake_parts.h"
#include "woodcock/bake/program.h"
#include "woodcock/base/error.h"

namespace woodcock::bake {

/// The bounds of an output in a region.
enum class Status { Empty, Constant, Varying };

/// The state of one thread.
struct Worker {
    Program::Workspace work;
    std::vector<OutputParts> outputs;
    std::vector<Region> pieces;
    std::array<std::array<double, 512>, 3> positions{};
    std::uint64_t evaluatedLeaves = 0;
};

/// A recipe, ready to be baked: its stages have been run.
struct Plan {
    Graph graph;
    std::vector<RecipeOutput> outputs;
    Box3d bounds;
    std::string boundsPlace;
};

/// Bakes one plan: finds the pieces where values vary, then bakes them leaf by leaf.
class Baker {
public:
    Baker(const Plan& recipe, const BakeSettings& settings, const BakeProgress& progress)
        : recipe_(recipe), settings_(settings), progress_(progress), program_(makeProgram(recipe)) {
        findIndexBox();
    }

    std::optional<Bake> run();

private:
    static Program makeProgram(const Plan& recipe) {
        std::vector<int> roots;
        for (const RecipeOutput& output : recipe.outputs) roots.push_back(output.entry);
        return {recipe.graph, roots};
    }

    void findIndexBox();
    std::vector<Region> rootRegions() const;
    std::vector<Status> inspect(const Region& region, Worker& worker,
                                std::vector<Bounds>& bounds) const;
    template <class Visit>
    void descend(const Region& region, int smallest, const Visit& visit);
    void findPieces();
    void checkAmount();
    Error tooMuch(double voxels) const;
    double guessVoxels();
    void fillRegion(const Region& region, const std::vector<Status>& status,
                    const std::vector<Bounds>& bounds, Worker& worker) const;
    void bakeLeaf(const Region& region, const std::vector<Status>& status,
                  const std::vector<Bounds>& bounds, Worker& worker);
    void countAtBounds(const Region& region, const std::array<std::uint64_t, 8>* active,
                       OutputParts& output) const;
    void finishPiece();
    Bake assemble();
    void refuseFaulty(const std::vector<OutputParts>& outputs) const;
    void refuseEmpty(const std::vector<OutputParts>& outputs, std::uint64_t evaluated) const;
    Worker& worker() {
        Worker& mine = workers_.local();
        if (mine.outputs.empty())
            for (const RecipeOutput& output : recipe_.outputs)
                mine.outputs.emplace_back(output.channels);
        return mine;
    }

    static constexpr int pieceSize = 64;

    const Plan& recipe_;
    const BakeSettings& settings_;
    const BakeProgress& progress_;
    Program program_;
    Vec3i first_, last_;  ///< voxels inside the recipe's bounds, or around them where turned
    bool aligned_ = true;
    std::vector<Region> pieces_;  ///< where something varies
    tbb::enumerable_thread_specific<Worker> workers_;
    std::atomic<bool> stopped_{false};
    std::atomic<std::uint64_t> donePieces_{0};
    std::mutex progressMutex_;
};

inline bool any(const std::vector<Status>& status, Status wanted) {
    return std::find(status.begin(), status.end(), wanted) != status.end();
}

/// Goes down from a region to those of the smallest size that vary, `visit`ing them.
template <class Visit>
void Baker::descend(const Region& region, int smallest, const Visit& visit) {
    if (stopped_) return;
    Worker& mine = worker();
    std::vector<Bounds> bounds;
    const std::vector<Status> status = inspect(region, mine, bounds);
    if (!any(status, Status::Varying) || region.size == smallest) {
        visit(region, status, bounds, mine);
        return;
    }
    const int half = region.size / 2;
    const auto child = [&](int i) {
        descend({region.origin + Vec3i{i & 1, i >> 1 & 1, i >> 2} * half, half}, smallest, visit);
    };
    if (region.size > pieceSize)
        tbb::parallel_for(0, 8, child);
    else
        for (int i = 0; i < 8; ++i) child(i);
}

}  // namespace woodcock::bake
