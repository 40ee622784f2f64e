// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "woodcock/grid/vdb_header.h"

namespace woodcock {

/// Makes OpenVDB ready to open a file with this header, as long as it lives. OpenVDB refuses a
/// whole file for one grid of a type that it does not know (strings, say): those get a stand-in
/// meanwhile, whose metadata can be read and whose voxels must not be.
class OpenVdbTypes {
public:
    explicit OpenVdbTypes(const VdbHeader& header);
    ~OpenVdbTypes();
    OpenVdbTypes(const OpenVdbTypes&) = delete;
    OpenVdbTypes& operator=(const OpenVdbTypes&) = delete;

private:
    std::unique_lock<std::mutex> lock_;  // the registry is one for the whole process
    std::vector<std::string> standIns_;
};

/// Value type and number of channels of a tree type: {"float", 1} for "Tree_float_5_4_3"; channels
/// are 0 for a tree that cannot become a field.
struct VdbValueType {
    std::string name;
    int channels = 0;
};
VdbValueType valueTypeOf(const std::string& treeType);

/// Runs `read`, turning what OpenVDB throws into Error{Input} "cannot read <path>: ..." (or Failure
/// when memory runs out).
void withOpenVdbErrors(const std::filesystem::path& path, const std::function<void()>& read);

}  // namespace woodcock
