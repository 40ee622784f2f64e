// SPDX-License-Identifier: Apache-2.0
#pragma once

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
    std::optional<std::string> time;  ///< "0.5", or "0:2:0.1": from, to, step
    std::vector<int> frames;          ///< of --frames
    std::optional<double> rate;       ///< frames a second; frame 1 is at time 0
};

/// The bakes that are asked for, one at least, in their order. A range of times is numbered from 1.
/// Errors: Usage, with what was expected.
std::vector<BakeFrame> bakeFrames(const FrameOptions& options);

}  // namespace woodcock::tool
