// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/input_file.h"

#include "woodcock/base/error.h"
#include "woodcock/base/memory.h"
#include "woodcock/grid/vdb/file_bytes.h"

namespace woodcock::grid {

std::string readInput(const std::filesystem::path& path) {
    FileBytes file(path);
    if (file.size() > memoryLimit() / 2)
        throw failure("cannot read '{}': it has {}, and there are {} of memory", path.string(),
                      formatGiB(static_cast<double>(file.size())),
                      formatGiB(static_cast<double>(memoryLimit())));
    const std::span<const char> bytes = file.bytes(file.size());
    return {bytes.data(), bytes.size()};
}

}  // namespace woodcock::grid
