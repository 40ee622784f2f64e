// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

#include <istream>
#include <span>
#include <string>

#include "woodcock/grid/vdb/file_bytes.h"
#include "woodcock/grid/vdb/file.h"
#include "woodcock/grid/vdb/check_tree.h"

namespace woodcock {

/// The trees of OpenVDB 13's grids of half values, which older versions can hold as well, although
/// they know no such grids.
using HalfTree = openvdb::tree::Tree4<openvdb::math::half, 5, 4, 3>::Type;

/// The bytes of a tree in memory, and what is needed to read them. They have been walked: OpenVDB
/// can read them in bounds.
struct StoredTree {
    std::string treeType;
    openvdb::VersionId libraryVersion;
    std::uint32_t fileVersion = 0, compression = 0;
    bool savedAsHalf = false;
    VdbLayout layout;
    std::span<const char> bytes;  ///< from layout.topology to layout.end
};

/// Brings the tree of a grid into the memory of `file` and makes sure that OpenVDB can read it
/// there. `grid` as it was listed. Errors: Input.
StoredTree loadStoredTree(FileBytes& file, const GridListing& grid);

/// The metadata and transform of a grid, as OpenVDB has them, on a grid of the right type with an
/// empty tree; of floats where the file has halves, and then to be saved as half. Errors: Input.
openvdb::GridBase::Ptr readGridWithoutTree(FileBytes& file, const std::string& uniqueName);

/// Set up as OpenVDB's own archives set theirs up; reading beyond its end throws.
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

}  // namespace woodcock
