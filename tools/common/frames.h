// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tools/common/exit_codes.h"

namespace woodcock::tool {

// Frames of a sequence: --frames says which, and #### in names of files stands for their numbers;
// see withFrame(). Without --frames, one call works on one frame, and what follows finds calls that
// expect more.

/// The option --frames, which fills `frames`; empty: it is not given.
CLI::Option* addFrames(CLI::App& command, std::vector<int>& frames, const std::string& help);

/// The option --skip-existing.
CLI::Option* addSkipExisting(CLI::App& command, bool& skip);

/// Throws Error{Usage} on inputs that are frames of a sequence (names that differ in numbers alone;
/// not with `overlay`) and folders; and, unless `frames` are asked for, on patterns that stand for
/// a frame's number and name no file.
void checkNoFrames(const std::vector<std::filesystem::path>& inputs, bool overlay, bool frames);

/// Throws Error{Usage} where none of the inputs holds a place for the number.
void checkFrameInputs(const std::vector<std::filesystem::path>& inputs);

/// Throws Error{Usage} where `output` has no place for the numbers of `frames`, or one for numbers
/// that there are not. `place`: where it was named, such as "--output"; may be empty.
void checkFrameOutput(const std::filesystem::path& output, const std::string& place,
                      const std::vector<int>& frames);

/// Throws Error{Usage} on an output whose name holds a pattern for frames, which would stay in the
/// file's name. `place`: where it was given; may be empty.
void checkNoPattern(const std::filesystem::path& output, const std::string& place);

/// `file` with the frame's number filled in.
std::filesystem::path inFrame(const std::filesystem::path& file, int frame);

/// Files there are, all of them, and one at least.
bool allExist(const std::vector<std::filesystem::path>& files);

/// How frames went.
struct FrameReport {
    std::vector<int> done, failed;
    ExitCode code = exitDone;  ///< of the last that failed
    bool interrupted = false;
};

/// Calls work(frame) for each of `frames`, until an interrupt. An Error that it throws is logged
/// with the frame's number, as is that memory is short, and the rest goes on. A code other than
/// exitDone is a failure, too, which `work` has told of; exitInterrupted ends it. Throws
/// Error{Usage} of the first frame: what is asked for is wrong for all.
FrameReport forEachFrame(const std::vector<int>& frames,
                         const std::function<ExitCode(int frame)>& work);

/// Ends the command with exitInterrupted or exitFailed, and says why, unless all went well; with
/// the code of its failure where there was one frame.
void endUnlessDone(const FrameReport& report);

}  // namespace woodcock::tool
