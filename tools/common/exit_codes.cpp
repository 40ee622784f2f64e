// SPDX-License-Identifier: Apache-2.0
#include "tools/common/exit_codes.h"

#include <CLI/CLI.hpp>

namespace woodcock::tool {

ExitCode exitCodeOf(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::Failure:
            return exitFailed;
        case ErrorKind::Usage:
            return exitWrongUsage;
        case ErrorKind::Input:
            return exitBadInput;
    }
    return exitFailed;
}

void endWith(ExitCode code) { throw CLI::RuntimeError(code); }

}  // namespace woodcock::tool
