// SPDX-License-Identifier: Apache-2.0
#include "tests/support/paths.h"

namespace woodcock::test {

std::filesystem::path program() { return WOODCOCK_PROGRAM; }

std::filesystem::path renderEachProgram() { return WOODCOCK_RENDER_EACH; }
std::filesystem::path fakeOidn() { return WOODCOCK_FAKE_OIDN; }
std::filesystem::path sourceDir() { return WOODCOCK_SOURCE_DIR; }

std::filesystem::path sharedDir() { return sourceDir().parent_path() / "shared"; }

}  // namespace woodcock::test
