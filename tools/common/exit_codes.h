// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/base/error.h"

namespace woodcock::tool {

/// What the program's exit code tells its caller. The help of the program lists them, too.
enum ExitCode {
    exitDone = 0,
    exitFailed = 1,        ///< while working, or what was checked does not hold
    exitWrongUsage = 2,    ///< of the command line
    exitBadInput = 3,      ///< a file that is wrong
    exitInterrupted = 130  ///< by a signal: as shells have it for SIGINT
};

ExitCode exitCodeOf(ErrorKind kind);

/// Ends the command with this code. What went wrong has been told already.
[[noreturn]] void endWith(ExitCode code);

}  // namespace woodcock::tool
