// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb_types.h"

#include <openvdb/openvdb.h>

#include <exception>
#include <new>
#include <string_view>

#include "woodcock/base/error.h"

namespace woodcock {

namespace {

std::mutex registryMutex;

struct Registry : openvdb::GridBase {  // for access to what is protected there
    using GridBase::registerGrid;
    using GridBase::unregisterGrid;
};

openvdb::GridBase::Ptr makeStandIn() { return openvdb::MaskGrid::create(); }

}  // namespace

OpenVdbTypes::OpenVdbTypes(const VdbHeader& header) : lock_(registryMutex) {
    openvdb::initialize();
    for (const VdbHeader::Entry& entry : header.entries) {
        if (openvdb::GridBase::isRegistered(entry.treeType)) continue;
        Registry::registerGrid(entry.treeType, makeStandIn);
        standIns_.push_back(entry.treeType);
    }
}

OpenVdbTypes::~OpenVdbTypes() {
    for (const std::string& type : standIns_) Registry::unregisterGrid(type);
}

VdbValueType valueTypeOf(const std::string& treeType) {
    constexpr std::string_view start = "Tree_", nodes = "_5_4_3";
    std::string name = treeType;
    if (name.starts_with(start)) name.erase(0, start.size());
    const bool usualNodes = name.ends_with(nodes);
    if (usualNodes) name.resize(name.size() - nodes.size());
    if (name == "ptdataidx32" || name == "ptidx32") return {"points", 0};
    if (!usualNodes) return {name, 0};
    for (const char* scalar : {"float", "double", "int32", "int64", "bool", "mask"})
        if (name == scalar) return {name, 1};
    for (const char* vector : {"vec3s", "vec3d", "vec3i"})
        if (name == vector) return {name, 3};
    return {name, 0};
}

void withOpenVdbErrors(const std::filesystem::path& path, const std::function<void()>& read) {
    try {
        read();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw failure("out of memory while reading {}", path.string());
    } catch (const std::exception& e) {
        throw inputError("cannot read {}: {}", path.string(), e.what());
    }
}

}  // namespace woodcock
