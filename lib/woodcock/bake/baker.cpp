// SPDX-License-Identifier: Apache-2.0
#include "woodcock/bake/baker.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <cmath>

#include "woodcock/bake/openvdb_baker.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_transform.h"

namespace woodcock::bake {

void Baker::findIndexBox() {
    const Affine3d& world = settings_.worldFromIndex;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (i != j && world.column[static_cast<std::size_t>(i)][j] != 0) aligned_ = false;
    const Box3d box = world.inverse().box(recipe_.bounds);
    constexpr double most = 1 << 30;
    for (int i = 0; i < 3; ++i) {
        if (!(box.lower[i] > -most && box.upper[i] < most))
            throw inputError(
                "{}: the recipe's bounds reach voxel {:.3g} along {}; the largest possible index "
                "is {:.0f}. Choose larger voxels",
                recipe_.boundsPlace, std::max(std::abs(box.lower[i]), std::abs(box.upper[i])),
                "xyz"[i], most);
        // Rounding must not leave out a voxel that lies on the bounds.
        first_[i] = static_cast<int>(std::ceil(box.lower[i] - 1e-6));
        last_[i] = static_cast<int>(std::floor(box.upper[i] + 1e-6));
    }
}

/// At most eight regions of one size, a power of two, that cover the box.
std::vector<Region> Baker::rootRegions() const {
    int size = pieceSize;
    const auto fits = [&](int axis) { return std::int64_t{last_[axis]} - first_[axis] < size; };
    while (!(fits(0) && fits(1) && fits(2)) && size < 1 << 30) size *= 2;
    const auto down = [size](int v) { return v & ~(size - 1); };
    std::vector<Region> regions;
    for (int x = down(first_.x); x <= last_.x; x += size)
        for (int y = down(first_.y); y <= last_.y; y += size)
            for (int z = down(first_.z); z <= last_.z; z += size)
                regions.push_back({{x, y, z}, size});
    return regions;
}

std::vector<Status> Baker::inspect(const Region& region, Worker& worker,
                                   std::vector<Bounds>& bounds) const {
    const std::vector<RecipeOutput>& outputs = recipe_.outputs;
    std::vector<Status> status(outputs.size(), Status::Empty);
    const Vec3i last = region.last();
    bool outside = false, inside = aligned_;
    for (int i = 0; i < 3; ++i) {
        outside |= last[i] < first_[i] || region.origin[i] > last_[i];
        inside &= region.origin[i] >= first_[i] && last[i] <= last_[i];
    }
    if (outside) return status;
    const Vec3i from = max(region.origin, first_), to = min(last, last_);
    Box3d box = settings_.worldFromIndex.box({from.as<double>(), to.as<double>()});
    if (!aligned_)  // sums of products round
        for (int i = 0; i < 3; ++i) {
            const double slack =
                1e-12 * (std::abs(box.lower[i]) + std::abs(box.upper[i]) + box.size()[i]);
            box.lower[i] -= slack, box.upper[i] += slack;
        }
    bounds = program_.bound(box, worker.work);
    for (std::size_t o = 0; o < outputs.size(); ++o) {
        bool empty = true, constant = inside;
        for (std::size_t c = 0; c < static_cast<std::size_t>(outputs[o].channels); ++c) {
            const Interval& v = bounds[o][c];
            empty &= v.lower >= -outputs[o].tolerance && v.upper <= outputs[o].tolerance;
            constant &= v.isConstant();
        }
        if (outputs[o].mask) empty = false;  // zero is a value there
        status[o] = empty ? Status::Empty : constant ? Status::Constant : Status::Varying;
    }
    for (std::size_t o = 0; o < outputs.size(); ++o)
        if (outputs[o].mask &&
            status[static_cast<std::size_t>(*outputs[o].mask)] != Status::Constant)
            status[o] = status[static_cast<std::size_t>(*outputs[o].mask)];
    return status;
}

/// Adds the constant values of a region without varying outputs.
void Baker::fillRegion(const Region& region, const std::vector<Status>& status,
                       const std::vector<Bounds>& bounds, Worker& worker) const {
    for (std::size_t o = 0; o < status.size(); ++o) {
        if (status[o] != Status::Constant) continue;
        std::array<float, 3> value{};
        bool finite = true;
        for (std::size_t c = 0; c < static_cast<std::size_t>(recipe_.outputs[o].channels); ++c) {
            value[c] = static_cast<float>(bounds[o][c].lower);
            finite &= std::isfinite(value[c]);
            worker.outputs[o].addRange(value[c]);
        }
        if (!finite) {
            const auto side = static_cast<std::uint64_t>(region.size);
            worker.outputs[o].faulty.add(region.origin, side * side * side);
            continue;
        }
        countAtBounds(region, nullptr, worker.outputs[o]);
        std::visit([&](auto& parts) { parts.add(region, value); }, worker.outputs[o].parts);
    }
}

void Baker::finishPiece() {
    const std::uint64_t done = ++donePieces_;
    if (!progress_) return;
    const std::unique_lock lock(progressMutex_, std::try_to_lock);
    if (!lock) return;
    const double share = static_cast<double>(done) / static_cast<double>(pieces_.size());
    if (!progress_(share)) stopped_ = true;
}

/// Active voxels of the region, or of its leaf's mask, that lie next to the recipe's bounds.
void Baker::countAtBounds(const Region& region, const std::array<std::uint64_t, 8>* active,
                          OutputParts& output) const {
    if (!aligned_) return;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            const int face = side ? last_[axis] : first_[axis];
            if (face < region.origin[axis] || face > region.last()[axis]) continue;
            std::uint64_t& count =
                output.statistics.atBounds[static_cast<std::size_t>(2 * axis + side)];
            if (!active) {
                count += static_cast<std::uint64_t>(region.size) *
                         static_cast<std::uint64_t>(region.size);
                continue;
            }
            for (int i = 0; i < 512; ++i) {
                const Vec3i at{i >> 6, i >> 3 & 7, i & 7};
                if (at[axis] == face - region.origin[axis])
                    count += (*active)[static_cast<std::size_t>(i / 64)] >> (i % 64) & 1;
            }
        }
}

void Baker::bakeLeaf(const Region& region, const std::vector<Status>& status,
                     const std::vector<Bounds>& bounds, Worker& worker) {
    const std::vector<RecipeOutput>& outputs = recipe_.outputs;
    ++worker.evaluatedLeaves;
    std::array<std::uint64_t, 8> inside{};
    Points points{.count = 512};
    for (std::size_t i = 0; i < 512; ++i) {
        const auto n = static_cast<int>(i);
        const Vec3i at = region.origin + Vec3i{n >> 6, n >> 3 & 7, n & 7};
        const Vec3d p = settings_.worldFromIndex.point(at.as<double>());
        for (int c = 0; c < 3; ++c) worker.positions[static_cast<std::size_t>(c)][i] = p[c];
        bool within = aligned_ || recipe_.bounds.contains(p);
        for (int c = 0; c < 3; ++c) within &= at[c] >= first_[c] && at[c] <= last_[c];
        inside[i / 64] |= std::uint64_t{within} << (i % 64);
        points.box.add(p);
    }
    for (std::size_t c = 0; c < 3; ++c) points.at[c] = worker.positions[c].data();
    std::vector<char> wanted(outputs.size());
    for (std::size_t o = 0; o < outputs.size(); ++o) {
        if (status[o] == Status::Varying) wanted[o] = 1;
        if (wanted[o] && outputs[o].mask &&
            status[static_cast<std::size_t>(*outputs[o].mask)] == Status::Varying)
            wanted[static_cast<std::size_t>(*outputs[o].mask)] = 1;
    }
    const std::vector<Values> values = program_.evaluate(points, worker.work, wanted);

    std::vector<std::array<std::uint64_t, 8>> active(outputs.size(), inside);
    const auto make = [&](std::size_t o) {
        OutputParts& mine = worker.outputs[o];
        const auto channels = static_cast<std::size_t>(outputs[o].channels);
        if (status[o] == Status::Empty) {
            active[o] = {};
            return;
        }
        std::array<std::array<float, 512>, 3> leaf{};
        if (outputs[o].mask) active[o] = active[static_cast<std::size_t>(*outputs[o].mask)];
        for (std::size_t i = 0; i < 512; ++i) {
            std::uint64_t& word = active[o][i / 64];
            const std::uint64_t bit = std::uint64_t{1} << (i % 64);
            if (!(word & bit)) continue;
            double largest = 0;
            bool finite = true;
            for (std::size_t c = 0; c < channels; ++c) {
                const double v = wanted[o] ? values[o].channel[c][i] : bounds[o][c].lower;
                leaf[c][i] = static_cast<float>(v);
                finite &= std::isfinite(leaf[c][i]);
                largest = std::max(largest, std::abs(double(leaf[c][i])));
            }
            if (!finite) {
                const auto n = static_cast<int>(i);
                mine.faulty.add(region.origin + Vec3i{n >> 6, n >> 3 & 7, n & 7});
                word &= ~bit;
                continue;
            }
            mine.greatestAnywhere = std::max(mine.greatestAnywhere, largest);
            if (!outputs[o].mask && largest <= outputs[o].tolerance) {
                word &= ~bit;
                continue;
            }
            for (std::size_t c = 0; c < channels; ++c) mine.addRange(leaf[c][i]);
        }
        std::uint64_t some = 0;
        for (const std::uint64_t word : active[o]) some |= word;
        if (!some) return;
        countAtBounds(region, &active[o], mine);
        std::visit([&](auto& parts) { parts.add(region.origin, leaf, active[o]); }, mine.parts);
    };
    for (std::size_t o = 0; o < outputs.size(); ++o)
        if (!outputs[o].mask) make(o);
    for (std::size_t o = 0; o < outputs.size(); ++o)
        if (outputs[o].mask) make(o);
}

void Baker::refuseFaulty(const std::vector<OutputParts>& outputs) const {
    for (std::size_t o = 0; o < outputs.size(); ++o) {
        const grid::VoxelCount& faulty = outputs[o].faulty;
        if (faulty.count == 0) continue;
        const Vec3d at = settings_.worldFromIndex.point(faulty.first.as<double>());
        throw inputError(
            "{}: output '{}' is not finite at {} voxels, first at [{}, {}, {}], world position "
            "[{:g}, {:g}, {:g}]",
            recipe_.outputs[o].place, recipe_.outputs[o].name, faulty.count, faulty.first.x,
            faulty.first.y, faulty.first.z, at.x, at.y, at.z);
    }
}

void Baker::refuseEmpty(const std::vector<OutputParts>& outputs, std::uint64_t evaluated) const {
    const RecipeOutput& output = recipe_.outputs.front();
    for (int i = 0; i < 3; ++i)
        if (first_[i] > last_[i])
            throw inputError(
                "{}: no voxel lies within the recipe's bounds, which are [{:g}, {:g}] along {}; "
                "choose smaller voxels",
                recipe_.boundsPlace, recipe_.bounds.lower[i], recipe_.bounds.upper[i], "xyz"[i]);
    if (evaluated == 0)
        throw inputError(
            "{}: the grid is empty: output '{}' is at most {:g} everywhere within the recipe's "
            "bounds, "
            "[{:g}, {:g}, {:g}] to [{:g}, {:g}, {:g}]",
            output.place, output.name, output.tolerance, recipe_.bounds.lower.x,
            recipe_.bounds.lower.y, recipe_.bounds.lower.z, recipe_.bounds.upper.x,
            recipe_.bounds.upper.y, recipe_.bounds.upper.z);
    throw inputError(
        "{}: the grid is empty: the largest of {} values of output '{}' is {:g}, and values of at "
        "most {:g} are left out. Are its features smaller than the voxels?",
        output.place, evaluated, output.name, outputs.front().greatestAnywhere, output.tolerance);
}

Bake Baker::assemble() {
    std::vector<OutputParts> totals;
    for (const RecipeOutput& output : recipe_.outputs) totals.emplace_back(output.channels);
    std::uint64_t evaluated = 0;
    for (const Worker& worker : workers_) {
        evaluated += worker.evaluatedLeaves * 512;
        for (std::size_t o = 0; o < worker.outputs.size(); ++o) totals[o].add(worker.outputs[o]);
    }
    refuseFaulty(totals);

    Bake bake{.grids = std::make_shared<grid::VdbGrids>(), .evaluatedVoxels = evaluated};
    bool something = false;
    for (std::size_t o = 0; o < recipe_.outputs.size(); ++o) {
        const RecipeOutput& output = recipe_.outputs[o];
        const auto gather = [&]<class Tree>() {
            std::vector<Parts<Tree>*> parts;
            for (Worker& worker : workers_)
                if (!worker.outputs.empty())
                    parts.push_back(&std::get<Parts<Tree>>(worker.outputs[o].parts));
            return makeGrid<openvdb::Grid<Tree>>(parts, output.tolerance);
        };
        const openvdb::GridBase::Ptr grid = output.channels == 3
                                                ? gather.operator()<openvdb::Vec3STree>()
                                                : gather.operator()<openvdb::FloatTree>();
        grid->setName(output.name);
        grid->setGridClass(output.channels == 1 ? openvdb::GRID_FOG_VOLUME : openvdb::GRID_UNKNOWN);
        grid->setTransform(grid::openVdbTransform(settings_.worldFromIndex));
        BakedGridStatistics& statistics = totals[o].statistics;
        statistics.name = output.name;
        statistics.activeVoxels = grid->activeVoxelCount();
        const openvdb::TreeBase& tree = grid->constBaseTree();
        statistics.leaves = tree.leafCount();
        statistics.tiles = tree.activeTileCount();
        statistics.bytes = tree.memUsage();
        something |= statistics.activeVoxels > 0;
        bake.statistics.push_back(statistics);
        bake.grids->grids.push_back(grid);
    }
    if (!something) refuseEmpty(totals, evaluated);
    bake.boxVoxels = 1;
    for (int i = 0; i < 3; ++i) bake.boxVoxels *= double(last_[i]) - first_[i] + 1;
    return bake;
}

std::optional<Bake> Baker::run() {
    findPieces();
    checkAmount();
    const auto visit = [&](const Region& region, const std::vector<Status>& status,
                           const std::vector<Bounds>& bounds, Worker& mine) {
        if (any(status, Status::Varying))
            bakeLeaf(region, status, bounds, mine);
        else
            fillRegion(region, status, bounds, mine);
    };
    tbb::parallel_for(std::size_t{0}, pieces_.size(), [&](std::size_t i) {
        descend(pieces_[i], 8, visit);
        if (!stopped_) finishPiece();
    });
    if (stopped_) return std::nullopt;
    return assemble();
}

namespace {

/// Runs the stages of a graph in their order, and replaces each by the node that it makes. Returns
/// the number of voxels evaluated for them; absent where `progress` ended it.
std::optional<std::uint64_t> runStages(Plan& plan, const BakeSettings& settings,
                                       const BakeProgress& progress) {
    std::uint64_t evaluated = 0;
    for (std::size_t i = 0; i < plan.graph.entries.size(); ++i) {
        const Graph::Entry entry = plan.graph.entries[i];
        if (!entry.stage) continue;
        Plan inputs{plan.graph, {}, plan.bounds, plan.boundsPlace};
        const std::vector<std::string> names = entry.stage->gridNames();
        for (std::size_t k = 0; k < names.size(); ++k) {
            RecipeOutput output;
            output.name = names[k], output.entry = entry.inputs[k], output.place = entry.place;
            output.channels = plan.graph.entries[static_cast<std::size_t>(output.entry)].channels;
            if (k > 0) output.mask = 0;
            inputs.outputs.push_back(output);
        }
        const std::optional<Bake> bake = Baker(inputs, settings, progress).run();
        if (!bake) return std::nullopt;
        evaluated += bake->evaluatedVoxels;
        plan.graph.entries[i].node =
            entry.stage->run(*bake->grids, [&] { return !progress || progress(1); });
        if (!plan.graph.entries[i].node) return std::nullopt;
        plan.graph.entries[i].stage = nullptr;
        plan.graph.entries[i].inputs.clear();
    }
    return evaluated;
}

}  // namespace

BakeSettings cubicVoxels(double size) {
    return {.worldFromIndex = Affine3d::scale({size, size, size})};
}

std::optional<Bake> bakeRecipe(const Recipe& recipe, const BakeSettings& settings,
                               const BakeProgress& progress) {
    const auto start = std::chrono::steady_clock::now();
    openvdb::initialize();
    std::optional<tbb::global_control> allow;  // more threads than cores, where asked for
    if (settings.threads > 0)
        allow.emplace(tbb::global_control::max_allowed_parallelism,
                      static_cast<std::size_t>(settings.threads));
    tbb::task_arena arena(settings.threads > 0 ? settings.threads : tbb::task_arena::automatic);
    std::optional<Bake> bake;
    arena.execute([&] {
        grid::openVdbTransform(
            settings.worldFromIndex);  // throws before the work if it is not possible
        Plan plan{recipe.graph, recipe.outputs, recipe.bounds, recipe.boundsPlace};
        const std::optional<std::uint64_t> evaluated = runStages(plan, settings, progress);
        if (!evaluated) return;
        bake = Baker(plan, settings, progress).run();
        if (bake) bake->evaluatedVoxels += *evaluated;
    });
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    if (bake) bake->seconds = time.count();
    return bake;
}

std::vector<Vec3d> evaluateRecipe(const Recipe& recipe, std::size_t output,
                                  const std::vector<Vec3d>& positions) {
    const int roots[]{recipe.outputs[output].entry};
    const Program program(recipe.graph, roots);
    Program::Workspace work;
    std::vector<Vec3d> results;
    for (const Vec3d& p : positions) {
        Points points{.count = 1, .at = {&p.x, &p.y, &p.z}};
        points.box.add(p);
        const Values v = program.evaluate(points, work)[0];
        results.push_back({v.channel[0][0], v.channel[1][0], v.channel[2][0]});
    }
    return results;
}

}  // namespace woodcock::bake
