// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tests/support/paths.h"

namespace woodcock::test {

/// The scene that tests of several commands share, and tests/kill_and_resume.sh.
inline std::string fogScene() { return readText(sourceDir() / "tests/tools/fog.toml"); }

}  // namespace woodcock::test
