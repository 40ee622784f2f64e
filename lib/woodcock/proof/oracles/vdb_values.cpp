// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/oracles/vdb_values.h"

#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::oracle {

namespace {

openvdb::FloatGrid::Ptr readFloats(const std::filesystem::path& file, const std::string& grid) {
    openvdb::initialize();
    openvdb::io::File in(file.string());
    in.open(/*delayLoad=*/false);
    return openvdb::gridPtrCast<openvdb::FloatGrid>(in.readGrid(grid));
}

}  // namespace

std::size_t vdbTreeBytes(const std::filesystem::path& file, const std::string& grid) {
    return readFloats(file, grid)->tree().memUsage();
}

VdbValues::VdbValues(const std::filesystem::path& file, const std::string& grid) {
    const openvdb::FloatGrid::Ptr values = readFloats(file, grid);
    const openvdb::CoordBBox b = values->evalActiveVoxelBoundingBox();
    box = {{b.min().x(), b.min().y(), b.min().z()}, {b.max().x(), b.max().y(), b.max().z()}};
    const auto image = [&](double x, double y, double z) {
        const openvdb::Vec3d p = values->indexToWorld(openvdb::Vec3d(x, y, z));
        return Vec3d{p.x(), p.y(), p.z()};
    };
    worldFromIndex.translation = image(0, 0, 0);
    worldFromIndex.column = {image(1, 0, 0) - image(0, 0, 0), image(0, 1, 0) - image(0, 0, 0),
                             image(0, 0, 1) - image(0, 0, 0)};
    values_.resize(b.volume());
    auto access = values->getConstAccessor();
    for (auto i = b.begin(); i; ++i) {
        const float v = access.getValue(*i);
        values_[index({(*i).x(), (*i).y(), (*i).z()})] = v;
        largest = std::max(largest, double{v});
    }
}

}  // namespace woodcock::oracle
