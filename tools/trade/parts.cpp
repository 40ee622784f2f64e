// SPDX-License-Identifier: Apache-2.0
#include "tools/trade/parts.h"

#include "woodcock/base/version.h"

namespace woodcock::tool {

// JSON's library writes numbers that are not finite as null.
nlohmann::ordered_json toJson(const trade::Measured& m) {
    return {{"value", m.value}, {"se", m.se}};
}

nlohmann::ordered_json aboutWoodcock() { return {{"version", version()}}; }

}  // namespace woodcock::tool
