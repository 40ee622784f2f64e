// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "woodcock/base/temp_dir.h"

namespace woodcock::test {

std::filesystem::path program();            ///< the `woodcock` program of this build
std::filesystem::path renderEachProgram();  ///< tests/programs/render_each
std::filesystem::path fakeOidn();           ///< the library of tests/programs/fake_oidn.cpp
std::filesystem::path sourceDir();          ///< top of the source tree

/// Reference data that is not part of the repository, beside it; may be missing. A test that needs
/// it says so: `if (!exists(sharedDir() / "...")) GTEST_SKIP() << "no ...";`
std::filesystem::path sharedDir();

}  // namespace woodcock::test
