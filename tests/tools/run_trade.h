// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "tests/support/run_program.h"

namespace woodcock::test {

/// Runs `woodcock trade` with a budget of so many seconds, or of more where a busy machine says
/// that they are too few.
inline ProgramResult runTrade(const std::vector<std::string>& words, int budget) {
    constexpr int most = 600;
    while (true) {
        std::vector<std::string> all{"trade", "--budget", fmt::format("{}s", budget)};
        all.insert(all.end(), words.begin(), words.end());
        ProgramResult result = runProgram(all);
        const bool tooSmall =
            result.exitCode == 2 && result.err.find("too small") != std::string::npos;
        if (!tooSmall || budget > most) return result;
        budget *= 4;
    }
}

}  // namespace woodcock::test
