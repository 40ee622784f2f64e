// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/printable.h"

#include <fmt/format.h>

namespace woodcock {

std::string printable(std::string_view text) {
    std::string shown;
    for (const char c : text) {
        const auto u = static_cast<unsigned char>(c);
        shown += u < 0x20 || u == 0x7f ? fmt::format("\\x{:02x}", u) : std::string(1, c);
    }
    return shown;
}

}  // namespace woodcock
