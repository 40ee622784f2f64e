// SPDX-License-Identifier: Apache-2.0
#include "tests/proof/subjects.h"

namespace woodcock::proof {

std::vector<Check> closedForms() { return {}; }

}  // namespace woodcock::proof
