// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/oracles/vdb_voxels.h"

#include <algorithm>
#include <stdexcept>

#include "woodcock/base/random.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::oracle {

namespace {

Vec3i vec(const openvdb::Coord& c) { return {c.x(), c.y(), c.z()}; }

template <class V>
double valueOf(V value) {
    const auto v = static_cast<double>(value);
    return std::isfinite(v) && v > 0 ? v : 0;
}

/// Aligned cubes of one value: voxels and tiles that differ from the background.
struct Cube {
    Box3i box;
    double weightUpToHere;
};

template <class GridT>
bool read(const openvdb::GridBase::Ptr& base, int matterCount, std::uint64_t seed,
          VdbVoxels& voxels) {
    const auto grid = openvdb::gridPtrCast<GridT>(base);
    if (!grid) return false;
    const auto access = std::make_shared<typename GridT::ConstAccessor>(grid->getConstAccessor());
    voxels.at = [grid, access](Vec3i v) {  // the accessor refers to the grid's tree
        return valueOf(access->getValue({v.x, v.y, v.z}));
    };
    voxels.background = valueOf(grid->background());
    std::vector<Cube> cubes;
    openvdb::CoordBBox all;
    double sum = 0;
    for (auto i = grid->cbeginValueAll(); i; ++i) {
        const double value = valueOf(*i);
        if (value == voxels.background) continue;
        openvdb::CoordBBox b;
        i.getBoundingBox(b);
        all.expand(b);
        sum += value * static_cast<double>(b.volume());
        cubes.push_back({{vec(b.min()), vec(b.max())}, sum});
    }
    if (cubes.empty()) return true;
    voxels.box = {vec(all.min()), vec(all.max())};
    RandomStream random(seed);
    for (int i = 0; i < matterCount; ++i) {
        const double weight = random.uniform() * sum;
        const auto cube = std::find_if(cubes.begin(), cubes.end() - 1,
                                       [&](const Cube& c) { return c.weightUpToHere > weight; });
        const Vec3d size = (cube->box.upper - cube->box.lower).template as<double>();
        voxels.matter.push_back(cube->box.lower.template as<double>() +
                                size * Vec3d{random.uniform(), random.uniform(), random.uniform()});
        // Tiles are filled; around a lone voxel lies the ramp to its neighbours.
        for (int axis = 0; axis < 3; ++axis)
            if (size[axis] == 0) voxels.matter.back()[axis] += 0.8 * (random.uniform() - 0.5);
    }
    return true;
}

}  // namespace

VdbVoxels readVoxels(const std::filesystem::path& file, const std::string& name, int matterCount,
                     std::uint64_t seed) {
    openvdb::initialize();
    openvdb::io::File in(file.string());
    in.open(/*delayLoad=*/false);
    const openvdb::GridBase::Ptr grid = in.readGrid(name);
    VdbVoxels voxels;
    if (!(read<openvdb::FloatGrid>(grid, matterCount, seed, voxels) ||
          read<openvdb::DoubleGrid>(grid, matterCount, seed, voxels) ||
          read<openvdb::Int32Grid>(grid, matterCount, seed, voxels) ||
          read<openvdb::Int64Grid>(grid, matterCount, seed, voxels) ||
          read<openvdb::BoolGrid>(grid, matterCount, seed, voxels)))
        throw std::runtime_error(file.string() + ": grid '" + name + "' is not one of numbers");
    const auto image = [&](double x, double y, double z) {
        const openvdb::Vec3d p = grid->indexToWorld(openvdb::Vec3d(x, y, z));
        return Vec3d{p.x(), p.y(), p.z()};
    };
    const Vec3d origin = image(0, 0, 0);
    voxels.worldFromIndex = {
        {image(1, 0, 0) - origin, image(0, 1, 0) - origin, image(0, 0, 1) - origin}, origin};
    return voxels;
}

}  // namespace woodcock::oracle
