// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace woodcock::test {

/// A process of the `woodcock` program.
struct StartedProgram {
    pid_t process = -1;
    int end = -1;  ///< tells a StartEnd when the process has ended; -1: it is a child of ours
};

/// Whether this build can start the program again and again: those with sanitizers cannot.
bool canStartAgain();

/// Starts the program from where its libraries are loaded, which they are once for all starts of
/// this process. Such a start differs from others in two ways: pages of libraries that it has not
/// touched do not count as its memory, and destructors of static objects do not run at its end.
StartedProgram startAgain(const std::vector<std::string>& arguments, int out, int err);

}  // namespace woodcock::test
