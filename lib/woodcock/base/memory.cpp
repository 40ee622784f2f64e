// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/memory.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

namespace woodcock {

namespace {

namespace fs = std::filesystem;

std::optional<std::uint64_t> numberIn(const fs::path& file) {
    std::uint64_t number = 0;
    if (std::ifstream(file) >> number) return number;
    return {};  // also "max", where there is no limit
}

/// Of lines as "MemAvailable:  1234 kB" or "inactive_file 1234".
std::uint64_t numberOf(const fs::path& file, const std::string& name) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);)
        if (line.starts_with(name)) return std::stoull(line.substr(name.size()));
    return 0;
}

/// A control group that limits this process's memory.
struct ControlGroup {
    std::uint64_t limit = 0;
    std::uint64_t used = 0;  ///< without file caches, which the system frees when memory is needed
};

void addGroups(std::vector<ControlGroup>& groups, const fs::path& root, const std::string& path,
               const char* limit, const char* used) {
    // In a container the group's directory is the root. The limits of parent groups hold as well.
    for (fs::path at = path;; at = at.parent_path()) {
        const fs::path directory = root / at.relative_path();
        if (const auto most = numberIn(directory / limit); most && *most > 0) {
            const std::uint64_t cached = numberOf(directory / "memory.stat", "inactive_file ") +
                                         numberOf(directory / "memory.stat", "active_file ");
            const std::uint64_t all = numberIn(directory / used).value_or(0);
            groups.push_back({*most, all - std::min(all, cached)});
        }
        if (at == at.parent_path()) break;
    }
}

std::vector<ControlGroup> controlGroups() {
    std::vector<ControlGroup> groups;
    std::ifstream in("/proc/self/cgroup");
    for (std::string line; std::getline(in, line);) {
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (second == std::string::npos) continue;
        const std::string kind = line.substr(first + 1, second - first - 1),
                          path = line.substr(second + 1);
        if (kind.empty())  // version 2
            addGroups(groups, "/sys/fs/cgroup", path, "memory.max", "memory.current");
        else if (("," + kind + ",").find(",memory,") != std::string::npos)
            addGroups(groups, "/sys/fs/cgroup/memory", path, "memory.limit_in_bytes",
                      "memory.usage_in_bytes");
    }
    return groups;
}

}  // namespace

std::uint64_t memoryLimit() {
    std::uint64_t limit = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
                          static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    rlimit ours{};
    if (getrlimit(RLIMIT_AS, &ours) == 0 && ours.rlim_cur != RLIM_INFINITY)
        limit = std::min<std::uint64_t>(limit, ours.rlim_cur);
    for (const ControlGroup& group : controlGroups()) limit = std::min(limit, group.limit);
    return limit;
}

std::uint64_t memoryLeft() {
    std::uint64_t left = memoryLimit();
    constexpr std::uint64_t kilobyte = 1024;
    if (const std::uint64_t available = numberOf("/proc/meminfo", "MemAvailable:"))
        left = std::min(left, kilobyte * (available + numberOf("/proc/meminfo", "SwapFree:")));
    rlimit ours{};
    if (getrlimit(RLIMIT_AS, &ours) == 0 && ours.rlim_cur != RLIM_INFINITY) {
        const std::uint64_t held = numberIn("/proc/self/statm").value_or(0) *
                                   static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
        left = std::min<std::uint64_t>(left, ours.rlim_cur - std::min(ours.rlim_cur, held));
    }
    for (const ControlGroup& group : controlGroups())
        left = std::min(left, group.limit - std::min(group.limit, group.used));
    return left;
}

std::string formatGiB(double bytes) {
    const double gib = bytes / (1024.0 * 1024 * 1024);
    return fmt::format("{:.{}f} GiB", gib, gib < 1 ? 2 : gib < 100 ? 1 : 0);
}

}  // namespace woodcock
