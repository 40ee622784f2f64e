// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb/check_grid_head.h"

#include <algorithm>
#include <istream>
#include <map>

#include "woodcock/base/printable.h"
#include "woodcock/grid/vdb/openvdb_transform.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::grid {

namespace {

constexpr std::size_t longestText = 4096;

/// Lets OpenVDB read from at most `most` of the next bytes, and stops where it stopped.
template <class Read>
void readThrough(FileBytes& file, std::uint64_t most, Read&& read) {
    const std::uint64_t begin = file.position();
    MemoryBuffer buffer(file.bytes(std::min(most, file.left())));
    std::istream stream(&buffer);
    stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
    read(stream);
    file.seek(begin + static_cast<std::uint64_t>(stream.tellg()));
}

/// Null for a type that OpenVDB does not know.
openvdb::Metadata::Ptr readMetadatum(FileBytes& file, const std::string& type) {
    const std::uint64_t begin = file.position();
    const std::uint64_t bytes = sizeof(std::uint32_t) + file.value<std::uint32_t>();
    file.seek(begin);
    if (bytes > file.left()) throw file.damaged(fmt::format("metadata of {} bytes", bytes));
    if (!openvdb::Metadata::isRegisteredType(type)) {
        file.skip(bytes);
        return {};
    }
    const openvdb::Metadata::Ptr datum = openvdb::Metadata::createMetadata(type);
    readThrough(file, bytes, [&](std::istream& stream) { datum->read(stream); });
    if (file.position() != begin + bytes)
        throw file.damaged(fmt::format("metadata of type {} in {} bytes", type, bytes));
    return datum;
}

void readMetadata(FileBytes& file, VdbGridHead& head) {
    std::map<std::string, std::string> texts;
    for (auto n = file.value<std::uint32_t>(); n > 0; --n) {
        const std::string key = file.text();
        const std::string type = file.text();
        if (key == openvdb::GridBase::META_FILE_DELAYED_LOAD) {  // a cache of sizes; not needed
            file.skip(file.value<std::uint32_t>());
            continue;
        }
        const openvdb::Metadata::Ptr datum = readMetadatum(file, type);
        std::string text = datum ? datum->str() : "<binary data>";
        if (key == openvdb::GridBase::META_GRID_NAME) head.name = printable(text);
        if (key == openvdb::GridBase::META_GRID_CLASS) head.gridClass = text;
        if (key == openvdb::GridBase::META_SAVE_HALF_FLOAT)
            // The byte of a damaged flag may be neither 0 nor 1, which is not a bool in C++: so its
            // text is read.
            head.savedAsHalf = datum && (type == "bool" ? text == "true" : datum->asBool());
        if (text.size() <= longestText) texts[key] = std::move(text);
    }
    head.metadata.assign(texts.begin(), texts.end());
}

void readTransform(FileBytes& file, VdbGridHead& head) {
    constexpr std::uint64_t frustumBytes = 8 * sizeof(double), largestMap = 256;
    const std::string frustumType = openvdb::math::NonlinearFrustumMap::mapType();
    std::string type = file.text();
    if (type == frustumType) {  // its box, taper and depth, then a linear map
        head.frustum = true;
        file.skip(frustumBytes);
        type = file.text();
    }
    if (type == frustumType || !openvdb::math::MapRegistry::isRegistered(type))
        throw file.damaged("a transform of unknown type");
    const openvdb::math::MapBase::Ptr map = openvdb::math::MapRegistry::createMap(type);
    readThrough(file, largestMap, [&](std::istream& stream) { map->read(stream); });
    if (!head.frustum) head.worldFromIndex = affineOf(*map);
}

}  // namespace

VdbGridHead readGridHead(FileBytes& file) {
    openvdb::initialize();
    VdbGridHead head;
    head.compression = file.value<std::uint32_t>();
    try {
        readMetadata(file, head);
        readTransform(file, head);
    } catch (const openvdb::Exception& e) {
        throw file.damaged(e.what());
    } catch (const std::ios_base::failure&) {
        throw file.damaged("more than the file holds");
    }
    return head;
}

}  // namespace woodcock::grid
