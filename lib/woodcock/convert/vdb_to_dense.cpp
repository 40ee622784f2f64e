// SPDX-License-Identifier: Apache-2.0
#include <openvdb/tools/Dense.h>

#include "woodcock/base/error.h"
#include "woodcock/base/memory.h"
#include "woodcock/convert/dense_to_vdb.h"
#include "woodcock/convert/openvdb_each_type.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_transform.h"

namespace woodcock::convert {

namespace {

openvdb::CoordBBox boxOf(const openvdb::GridBase& grid, const std::optional<Box3i>& wanted) {
    if (wanted) {
        const auto coord = [](Vec3i v) { return openvdb::Coord(v.x, v.y, v.z); };
        return {coord(wanted->lower), coord(wanted->upper)};
    }
    const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    if (box.empty())
        throw inputError("grid '{}' is empty: it has no active voxels to write", grid.getName());
    return box;
}

template <class GridT>
void copyVoxels(const GridT& grid, const openvdb::CoordBBox& box, std::uint64_t bytes,
                DenseVolume& volume) {
    using Value = typename GridT::ValueType;
    auto samples = std::shared_ptr<char[]>(new char[bytes]);
    openvdb::tools::Dense<Value, openvdb::tools::LayoutXYZ> dense(
        box, reinterpret_cast<Value*>(samples.get()));
    openvdb::tools::copyToDense(grid, dense);
    volume.samples = samples.get();
    volume.owner = std::move(samples);
}

}  // namespace

DenseVolume vdbToDense(const grid::VdbGrids& grids, std::size_t i,
                       const std::optional<Box3i>& wanted) {
    openvdb::GridBase& grid = *grids.grids.at(i);
    const openvdb::CoordBBox box = boxOf(grid, wanted);
    DenseVolume volume;
    volume.name = grid.getName();
    const openvdb::Coord first = box.min(), last = box.max();
    volume.dims = {std::int64_t{last.x()} - first.x() + 1, std::int64_t{last.y()} - first.y() + 1,
                   std::int64_t{last.z()} - first.z() + 1};
    volume.worldFromIndex = grid::affineOf(*grid.transform().baseMap()) *
                            Affine3d::translate(Vec3i{first[0], first[1], first[2]}.as<double>());
    volume.placed = true;
    const bool copied = withFloatingGrid(grid, [&]<class GridT>(const GridT& typed) {
        using Traits = VoxelTraits<typename GridT::ValueType>;
        volume.channels = Traits::channels;
        volume.type =
            std::is_same_v<typename Traits::Number, float> ? SampleType::F32 : SampleType::F64;
        volume.setStridesXFirst();
        const auto bytes = denseBytes(volume.dims, volume.channels, volume.type);
        const double needed =
            (bytes ? static_cast<double>(*bytes) : 1e30) + static_cast<double>(typed.memUsage());
        if (needed > static_cast<double>(memoryLimit()))
            throw inputError(
                "grid '{}' spans {} x {} x {} voxels, too many for this machine's {} of memory; "
                "choose a part by --bounds",
                volume.name, volume.dims[0], volume.dims[1], volume.dims[2],
                formatGiB(static_cast<double>(memoryLimit())));
        copyVoxels(typed, box, *bytes, volume);
    });
    if (!copied)
        throw inputError("grid '{}' holds values of type {}, which are not numbers", volume.name,
                         grid.valueType());
    return volume;
}

}  // namespace woodcock::convert
