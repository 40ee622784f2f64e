// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb/read_grids.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <type_traits>

#include "woodcock/base/error.h"
#include "woodcock/grid/nanovdb/file.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_stored_tree.h"

namespace woodcock::grid {

namespace {

/// True where the tree is of this type.
template <class TreeT>
bool readAs(const StoredTree& stored, openvdb::GridBase& grid) {
    if (stored.treeType != TreeT::treeType()) return false;
    const auto tree = std::make_shared<TreeT>();
    TreeStream topology(stored);
    tree->readTopology(topology, stored.savedAsHalf);
    std::vector<typename TreeT::LeafNodeType*> leaves;
    leaves.reserve(stored.layout.leaves.size());
    tree->getNodes(leaves);
    if (leaves.size() != stored.layout.leaves.size())
        throw std::runtime_error("the leaves lie elsewhere than the tree says");
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, leaves.size(), 128),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          TreeStream stream(stored);
                          openvdb::io::setGridBackgroundValuePtr(stream, &tree->background());
                          for (std::size_t i = range.begin(); i != range.end(); ++i)
                              readLeafOf(stored, stream, i, *leaves[i]);
                      });
    if constexpr (std::is_same_v<TreeT, HalfTree>)
        grid.setTree(std::make_shared<openvdb::FloatTree>(*tree));
    else
        grid.setTree(tree);
    return true;
}

template <class... TreeT>
bool readAsOneOf(const StoredTree& stored, openvdb::GridBase& grid) {
    return (readAs<TreeT>(stored, grid) || ...);
}

openvdb::GridBase::Ptr readOne(const VdbFile& listed, const GridListing& listing) {
    if (!isReadable(listing))
        throw inputError("grid '{}' in {} cannot be used: {}", listing.uniqueName,
                         listed.path.string(), listing.unusable);
    if (listed.nanoVdb)
        return readNanoVdbGrid(listed.path, indexOf(listed, listing.uniqueName)).grids.front();
    FileBytes file(listed.path);
    try {
        const openvdb::GridBase::Ptr grid = readGridWithoutTree(file, listing.uniqueName);
        const StoredTree stored = loadStoredTree(file, listing);
        using namespace openvdb;
        if (!readAsOneOf<FloatTree, HalfTree, DoubleTree, Int32Tree, Int64Tree, BoolTree, MaskTree,
                         Vec3STree, Vec3DTree, Vec3ITree>(stored, *grid))
            throw std::runtime_error("no reader for values of " + stored.treeType);
        return grid;
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw failure("out of memory while reading {}", listed.path.string());
    } catch (const std::exception& e) {
        throw inputError("{} is damaged: grid '{}': {}{}", listed.path.string(), listing.uniqueName,
                         e.what(), file.wayOut());
    }
}

}  // namespace

bool isReadable(const GridListing& grid) {
    if (grid.usable()) return true;
    if (grid.gridClass != GridClass::LevelSet || grid.channels == 0 || !grid.worldFromIndex)
        return false;
    return flawOf(*grid.worldFromIndex).empty();
}

VdbGrids readVdbGrids(const VdbFile& file, const std::vector<std::string>& uniqueNames) {
    VdbGrids read;
    for (const std::string& name : uniqueNames)
        read.grids.push_back(readOne(file, file.grids[indexOf(file, name)]));
    return read;
}

}  // namespace woodcock::grid
