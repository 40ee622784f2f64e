// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/program_starter.h"

namespace woodcock::test {

struct ProgramResult {
    int exitCode = -1;  ///< 128 + signal where one ended it
    std::string out, err;
    std::size_t residentBytes = 0;  ///< the most memory that it held at once
};

struct ProgramLimits {
    std::optional<std::size_t> fileSize{};      ///< writes beyond fail as on a full disk
    std::optional<std::size_t> addressSpace{};  ///< allocations beyond fail
    unsigned seconds = 0;  ///< of processor time until a signal ends it; 0: as long as it takes
};

/// Runs the `woodcock` program, or another, to its end, with no input.
ProgramResult runProgram(const std::vector<std::string>& arguments,
                         const ProgramLimits& limits = {},
                         const std::filesystem::path& program = {});

/// A `woodcock` program at work.
class RunningProgram {
public:
    explicit RunningProgram(const std::vector<std::string>& arguments);
    ~RunningProgram();  ///< kills one that has not been waited for
    RunningProgram(const RunningProgram&) = delete;
    RunningProgram& operator=(const RunningProgram&) = delete;

    /// The next line of stderr that holds `text`, as soon as it is there; empty when it never
    /// comes.
    std::string awaitLine(const std::string& text);
    /// Waits until a render with `--progress json` has so many samples of each pixel; false when it
    /// ends before.
    bool awaitSamples(int samples);
    void signal(int number);
    /// Waits for the end; `err` is what awaitLine() did not take, `out` is not kept.
    ProgramResult wait();

private:
    StartedProgram started_;
    FILE* err_ = nullptr;
};

}  // namespace woodcock::test
