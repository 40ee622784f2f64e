// SPDX-License-Identifier: Apache-2.0
#include "tools/common/scratch_directory.h"

#include <stdlib.h>

#include <cerrno>
#include <system_error>

#include "woodcock/base/error.h"

namespace woodcock::tool {

namespace fs = std::filesystem;

ScratchDirectory::ScratchDirectory() {
    std::string name = (fs::temp_directory_path() / "woodcock-XXXXXX").string();
    if (!mkdtemp(name.data()))
        throw failure("cannot make the directory '{}': {}", name,
                      std::generic_category().message(errno));
    path_ = name;
}

ScratchDirectory::~ScratchDirectory() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

}  // namespace woodcock::tool
