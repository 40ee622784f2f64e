// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/support/write_vdb.h"

#include <openvdb/io/Stream.h>
#include <openvdb/points/PointDataGrid.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "woodcock/base/temp_dir.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::proof {

namespace {

template <class V>
V as(const VdbValue& v) {
    if constexpr (openvdb::VecTraits<V>::IsVec) {
        using E = typename openvdb::VecTraits<V>::ElementType;
        return V(static_cast<E>(v[0]), static_cast<E>(v[1]), static_cast<E>(v[2]));
    } else if constexpr (std::is_same_v<V, bool>) {
        return v[0] != 0;
    } else if constexpr (std::is_same_v<V, openvdb::math::half>) {
        return V(static_cast<float>(v[0]));
    } else {
        return static_cast<V>(v[0]);
    }
}

template <class TreeT>
void fill(TreeT& tree, const GridSpec& spec) {
    using V = typename TreeT::ValueType;
    constexpr auto coord = [](Vec3i v) { return openvdb::Coord(v.x, v.y, v.z); };
    for (const VdbTile& t : spec.tiles) {
        const openvdb::Index level = t.size == 8 ? 1 : t.size == 128 ? 2 : 3;
        tree.addTile(level, coord(t.origin), as<V>(t.value), t.active);
    }
    openvdb::tree::ValueAccessor<TreeT> access(tree);
    for (int x = spec.box.lower.x; x <= spec.box.upper.x; ++x)
        for (int y = spec.box.lower.y; y <= spec.box.upper.y; ++y)
            for (int z = spec.box.lower.z; z <= spec.box.upper.z; ++z) {
                VdbValue value{};
                if (spec.colour) {
                    const Vec3d c = spec.colour({x, y, z});
                    value = {c.x, c.y, c.z};
                } else {
                    value[0] = spec.value({x, y, z});
                }
                if (value != spec.background) access.setValue({x, y, z}, as<V>(value));
            }
    for (const VdbVoxel& v : spec.voxels) {
        if (v.active)
            access.setValueOn(coord(v.at), as<V>(v.value));
        else
            access.setValueOff(coord(v.at), as<V>(v.value));
    }
}

/// A mask has no values but its active bits.
void fill(openvdb::MaskTree& tree, const GridSpec& spec) {
    for (const VdbVoxel& v : spec.voxels) tree.setValueOn({v.at.x, v.at.y, v.at.z});
}

template <class TreeT>
openvdb::GridBase::Ptr makeGrid(const GridSpec& spec) {
    using V = typename TreeT::ValueType;
    auto grid = openvdb::Grid<TreeT>::create(as<V>(spec.background));
    fill(grid->tree(), spec);
    return grid;
}

openvdb::GridBase::Ptr makeValues(const GridSpec& spec) {
    switch (spec.type) {
        case VdbType::Float:
            return makeGrid<openvdb::FloatTree>(spec);
        case VdbType::Half:
            return makeGrid<grid::HalfTree>(spec);
        case VdbType::Double:
            return makeGrid<openvdb::DoubleTree>(spec);
        case VdbType::Int32:
            return makeGrid<openvdb::Int32Tree>(spec);
        case VdbType::Int64:
            return makeGrid<openvdb::Int64Tree>(spec);
        case VdbType::Bool:
            return makeGrid<openvdb::BoolTree>(spec);
        case VdbType::Mask: {
            auto grid = openvdb::MaskGrid::create();
            fill(grid->tree(), spec);
            return grid;
        }
        case VdbType::Vec3s:
            return makeGrid<openvdb::Vec3STree>(spec);
        case VdbType::Vec3d:
            return makeGrid<openvdb::Vec3DTree>(spec);
        case VdbType::Vec3i:
            return makeGrid<openvdb::Vec3ITree>(spec);
        case VdbType::Points:
            return openvdb::points::PointDataGrid::create();
    }
    throw std::logic_error("no such VdbType");
}

openvdb::math::Transform::Ptr makeTransform(const GridSpec& spec) {
    using openvdb::math::Transform;
    if (spec.frustum) {
        const openvdb::BBoxd box(openvdb::Vec3d(0, 0, 0), openvdb::Vec3d(20, 20, 20));
        return Transform::createFrustumTransform(box, 0.5, 10.0, 0.1);
    }
    // OpenVDB's matrices act on row vectors: the images of the axes are its rows.
    openvdb::Mat4d m = openvdb::Mat4d::identity();
    for (int row = 0; row < 3; ++row)
        for (int i = 0; i < 3; ++i)
            m(row, i) = spec.worldFromIndex.column[static_cast<std::size_t>(row)][i];
    for (int i = 0; i < 3; ++i) m(3, i) = spec.worldFromIndex.translation[i];
    return Transform::createLinearTransform(m);
}

openvdb::GridPtrVec makeGrids(const std::vector<GridSpec>& specs) {
    openvdb::initialize();
    openvdb::GridPtrVec grids;
    for (const GridSpec& spec : specs) {
        openvdb::GridBase::Ptr grid = makeValues(spec);
        grid->setName(spec.name);
        if (spec.gridClass != "unknown")
            grid->setGridClass(openvdb::GridBase::stringToGridClass(spec.gridClass));
        grid->setSaveFloatAsHalf(spec.saveAsHalf);
        grid->setTransform(makeTransform(spec));
        for (const auto& [key, text] : spec.metadata)
            grid->insertMeta(key, openvdb::StringMetadata(text));
        grids.push_back(grid);
    }
    return grids;
}

}  // namespace

void writeVdb(const std::filesystem::path& file, const std::vector<GridSpec>& grids,
              VdbCompression compression) {
    openvdb::io::File out(file.string());
    std::uint32_t flags = openvdb::io::COMPRESS_ACTIVE_MASK;
    if (compression == VdbCompression::Zip) flags |= openvdb::io::COMPRESS_ZIP;
    if (compression == VdbCompression::Blosc) flags |= openvdb::io::COMPRESS_BLOSC;
    out.setCompression(flags);
    out.write(makeGrids(grids));
    if (std::any_of(grids.begin(), grids.end(),
                    [](const GridSpec& g) { return g.type == VdbType::Half; }))
        setVdbFormat(file, 225);
}

void streamVdb(const std::filesystem::path& file, const std::vector<GridSpec>& grids) {
    const openvdb::GridPtrVec made = makeGrids(grids);
    std::ofstream stream(file, std::ios::binary);
    openvdb::io::Stream(stream).write(made);
}

void setVdbFormat(const std::filesystem::path& file, std::uint32_t number) {
    std::string bytes = readText(file);
    std::memcpy(&bytes.at(8), &number, sizeof number);
    writeText(file, bytes);
}

void truncateFile(const std::filesystem::path& file, std::uintmax_t bytes) {
    std::filesystem::resize_file(file, bytes);
}

void patchFile(const std::filesystem::path& file, const std::string& from, const std::string& to) {
    if (from.size() != to.size()) throw std::logic_error("a patch keeps the length");
    std::string bytes = readText(file);
    std::size_t at = bytes.find(from), found = 0;
    for (; at != std::string::npos; at = bytes.find(from, at + to.size()), ++found)
        bytes.replace(at, from.size(), to);
    if (found == 0) throw std::logic_error("nothing to patch in " + file.string());
    writeText(file, bytes);
}

}  // namespace woodcock::proof
