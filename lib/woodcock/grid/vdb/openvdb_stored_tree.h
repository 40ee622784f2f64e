// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <istream>
#include <span>
#include <string>

#include "woodcock/grid/vdb/check_tree.h"
#include "woodcock/grid/vdb/file.h"
#include "woodcock/grid/vdb/file_bytes.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::grid {

/// The bytes of a tree in memory, and what is needed to read them. They have been checked: OpenVDB
/// can read them within bounds.
struct StoredTree {
    std::string treeType;
    openvdb::VersionId libraryVersion;
    std::uint32_t fileVersion = 0, compression = 0;
    bool savedAsHalf = false;
    VdbLayout layout;
    std::span<const char> bytes;  ///< from layout.topology to layout.end
};

/// Loads the tree of a grid, as it was listed, into the memory of `file`, and checks that OpenVDB
/// can read it there. Errors: Input.
StoredTree loadStoredTree(FileBytes& file, const GridListing& grid);

/// A grid of the right type with the metadata and transform of the file, and an empty tree. Where
/// the file has halves, its values are floats, and it is marked to be saved as half. Errors: Input.
openvdb::GridBase::Ptr readGridWithoutTree(FileBytes& file, const std::string& uniqueName);

/// A stream set up as OpenVDB's archives set up theirs. Reading beyond its end throws.
class TreeStream : public std::istream {
public:
    explicit TreeStream(const StoredTree& tree);
    void seek(std::uint64_t fileOffset) { seekg(static_cast<off_type>(fileOffset - begin_)); }

private:
    MemoryBuffer buffer_;
    std::uint64_t begin_;
};

/// Reads the voxels of leaf `i` in the order of the tree.
template <class Leaf>
void readLeafOf(const StoredTree& stored, TreeStream& stream, std::size_t i, Leaf& leaf) {
    const openvdb::Coord origin = leaf.origin();
    stream.seek(stored.layout.leaves[i]);
    leaf.readBuffers(stream, stored.savedAsHalf);
    if (leaf.origin() != origin)
        throw std::runtime_error("the origin of a leaf differs from its place in the tree");
}

}  // namespace woodcock::grid
