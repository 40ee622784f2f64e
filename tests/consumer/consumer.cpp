// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include "woodcock/base/version.h"

int main() { fmt::print("woodcock {}\n", woodcock::version()); }
