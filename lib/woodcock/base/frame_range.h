// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace woodcock {

/// Frames are numbered from -largestFrame to largestFrame.
inline constexpr int largestFrame = 99999999;
/// So many frames are asked for at once, at most.
inline constexpr int mostFrames = 100000;

/// The frames of "1-48,60,100-120x2", in the order in which they are named, each once. The grammar
/// of OpenImageIO's Filesystem::enumerate_sequence: A; A-B, which counts down where A is above B;
/// A-BxN, every Nth; A-ByN, all but these; and of fileseq: A-B:N, every Nth, then every (N-1)th
/// that is not there yet, and so on to all. Numbers may be negative: -10--1.
/// Throws Error{Usage} that says what was expected, also where no frame is left.
std::vector<int> parseFrameRange(std::string_view text);

/// The shortest way to say these frames by parseFrameRange(): "1-8,21-48". Duplicates and order are
/// lost.
std::string frameRangeText(std::vector<int> frames);

}  // namespace woodcock
