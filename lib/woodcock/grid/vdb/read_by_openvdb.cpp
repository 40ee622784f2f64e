// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb/read_by_openvdb.h"

#include <openvdb/openvdb.h>

#include "woodcock/base/error.h"

namespace woodcock {

VdbPeer readByOpenVdb(const std::filesystem::path& file, const std::string& grid) {
    try {
        openvdb::initialize();
        openvdb::io::File in(file.string());
        in.open(/*delayLoad=*/false);
        const openvdb::GridBase::Ptr read = in.readGrid(grid);
        return {read->activeVoxelCount(), read->memUsage()};
    } catch (const openvdb::Exception& e) {
        throw inputError("{}: OpenVDB cannot read grid '{}': {}", file.string(), grid, e.what());
    }
}

}  // namespace woodcock
