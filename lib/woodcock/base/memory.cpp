// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/memory.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace woodcock {

std::uint64_t memoryLimit() {
    std::uint64_t limit = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
                          static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    rlimit ours{};
    if (getrlimit(RLIMIT_AS, &ours) == 0 && ours.rlim_cur != RLIM_INFINITY)
        limit = std::min<std::uint64_t>(limit, ours.rlim_cur);
    // Control groups of version 2 and 1; "max" where there is no limit.
    for (const char* file :
         {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
        std::uint64_t bytes = 0;
        if (std::ifstream(file) >> bytes && bytes > 0) limit = std::min(limit, bytes);
    }
    return limit;
}

std::string formatGiB(double bytes) {
    const double gib = bytes / (1024.0 * 1024 * 1024);
    return fmt::format("{:.{}f} GiB", gib, gib < 1 ? 2 : gib < 100 ? 1 : 0);
}

}  // namespace woodcock
