// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb/openvdb_stored_tree.h"

#include <algorithm>
#include <vector>

#include "woodcock/base/error.h"
#include "woodcock/grid/vdb/check_grid_head.h"
#include "woodcock/grid/vdb/check_header.h"

namespace woodcock::grid {

namespace {

const VdbHeader::Entry& findEntry(const FileBytes& file, const VdbHeader& header,
                                  const std::string& uniqueName) {
    const auto found =
        std::find_if(header.entries.begin(), header.entries.end(),
                     [&](const VdbHeader::Entry& e) { return e.uniqueName == uniqueName; });
    if (found == header.entries.end())
        throw inputError("grid '{}' not found in {}", uniqueName, file.path().string());
    return *found;
}

void throwOnFailure(std::istream& stream) {
    stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
}

}  // namespace

StoredTree loadStoredTree(FileBytes& file, const GridListing& grid) {
    const std::string& uniqueName = grid.uniqueName;
    const VdbHeader header = readVdbHeader(file);
    const VdbHeader::Entry* entry = &findEntry(file, header, uniqueName);
    if (!entry->treeOf.empty()) entry = &findEntry(file, header, entry->treeOf);
    if (!entry->treeOf.empty())
        throw inputError("grid '{}' in {} shares the tree of '{}', which has no tree itself",
                         uniqueName, file.path().string(), entry->uniqueName);
    StoredTree stored;
    stored.treeType = entry->treeType;
    stored.libraryVersion = {header.libraryMajor, header.libraryMinor};
    stored.fileVersion = header.fileVersion;
    const VdbValueType type = valueTypeOf(entry->treeType);
    if (type.channels != grid.channels || type.channels == 0)
        throw inputError("grid '{}' in {} has type {}, which holds no values to render", uniqueName,
                         file.path().string(), type.name);
    file.enter(entry->begin, entry->end, fmt::format("grid '{}'", entry->uniqueName));
    file.loadAll();
    const VdbGridHead head = readGridHead(file);
    stored.compression = head.compression;
    stored.savedAsHalf = head.savedAsHalf;
    stored.layout = findLayout(file, type, head.compression, head.savedAsHalf);
    stored.bytes = file.loaded(stored.layout.topology, stored.layout.end);
    return stored;
}

openvdb::GridBase::Ptr readGridWithoutTree(FileBytes& file, const std::string& uniqueName) {
    openvdb::initialize();
    const VdbHeader header = readVdbHeader(file);
    const VdbHeader::Entry& entry = findEntry(file, header, uniqueName);
    file.enter(entry.begin, entry.end, fmt::format("grid '{}'", entry.uniqueName));
    readGridHead(file);  // makes sure that OpenVDB can read it
    const std::uint64_t begin = entry.begin + sizeof(std::uint32_t), end = file.position();
    file.seek(begin);
    MemoryBuffer buffer(file.bytes(end - begin));
    std::istream stream(&buffer);
    throwOnFailure(stream);
    openvdb::io::setVersion(stream, {header.libraryMajor, header.libraryMinor}, header.fileVersion);
    const bool half = entry.treeType == HalfTree::treeType();
    const openvdb::GridBase::Ptr grid =
        openvdb::GridBase::createGrid(half ? openvdb::FloatTree::treeType() : entry.treeType);
    grid->readMeta(stream);
    grid->readTransform(stream);
    if (half) grid->setSaveFloatAsHalf(true);
    grid->removeMeta(openvdb::GridBase::META_FILE_DELAYED_LOAD);
    return grid;
}

TreeStream::TreeStream(const StoredTree& tree)
    : std::istream(nullptr), buffer_(tree.bytes), begin_(tree.layout.topology) {
    rdbuf(&buffer_);
    throwOnFailure(*this);
    openvdb::io::setVersion(*this, tree.libraryVersion, tree.fileVersion);
    openvdb::io::setDataCompression(*this, tree.compression);
}

}  // namespace woodcock::grid
