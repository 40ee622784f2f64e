// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace woodcock::tool {

/// A bake of a sequence: what it is numbered, and the recipe's time there.
struct BakeFrame {
    std::optional<int> number;   ///< absent: there are no frames
    std::optional<double> time;  ///< seconds; absent: the recipe's own
};

/// What the command line says of time, as it is written.
struct FrameOptions {
    std::optional<std::string> time;    ///< "0.5", or "0:2:0.1": from, to, step
    std::optional<std::string> frames;  ///< "12", or "1-48"
    std::optional<double> rate;         ///< frames a second; frame 1 is at time 0
};

/// The bakes that are asked for, one at least, in their order. A range of times is numbered from 1.
/// Errors: Usage, with what was expected.
std::vector<BakeFrame> bakeFrames(const FrameOptions& options);

/// The file's name with the frame's number in place of #### (with as many digits at least); the
/// name itself for a bake without a number.
std::filesystem::path frameFile(const std::filesystem::path& file, const BakeFrame& frame);

/// Errors: Usage, where `file` names no place for numbers that there are, or one for numbers that
/// there are not.
void checkFrameFile(const std::filesystem::path& file, const char* option,
                    const std::vector<BakeFrame>& frames);

}  // namespace woodcock::tool
