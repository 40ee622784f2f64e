// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/version.h"

namespace woodcock {

std::string_view version() { return WOODCOCK_VERSION; }

}  // namespace woodcock
