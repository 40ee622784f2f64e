// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace woodcock {

/// Bytes that this process may hold at most: the machine's memory, or less where a container or the
/// shell (ulimit -v) sets a limit.
std::uint64_t memoryLimit();

/// Bytes that this process may still take now: the least of what is free in the machine, within the
/// shell's limit of addresses (ulimit -v), and within its control groups.
std::uint64_t memoryLeft();

/// For readers: "480 GiB", "23.4 GiB", "0.25 GiB".
std::string formatGiB(double bytes);

}  // namespace woodcock
