// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace woodcock::tool {

/// "woodcock 0.1.0", the commit, how it was compiled, what this processor can do, and all libraries
/// with their versions: several lines, without a line's end at the last.
std::string aboutProgram();

/// "woodcock 0.1.0 (d890f33ab12c)".
std::string programVersion();

}  // namespace woodcock::tool
