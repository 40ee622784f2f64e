// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "woodcock/scene/description.h"

namespace woodcock::scene {

// Files whose names hold a frame's number, as "smoke.####.vdb"; see withFrame().

/// The number of the file that a sequence shows in `frame`, of those that are on disk (one at
/// least, rising). Without rules, it is frame - start + 1 + offset. Outside of first and last file:
/// hold shows the nearer of them, repeat begins anew, ping_pong goes back and forth, without
/// showing either end twice in a row. Hold of a missing file shows the one before it. Nothing:
/// black. Throws Error{Input} that says which files there are.
std::optional<int> sequenceFile(const FileSequence& sequence, int frame,
                                std::span<const int> onDisk);

/// Whether names of files that the scene reads depend on the frame; outputs do not count.
bool readsFrames(const SceneDescription& scene);

/// Finds the files of frames. Each folder is listed once.
class FrameFiles {
public:
    /// The scene as it is in `frame`: the files of volumes are those of their sequences, and all
    /// other names have the frame filled in, outputs too. A volume without a file there is `black`.
    /// Throws Error{Input} with the place in the scene, where a volume has no such file.
    SceneDescription at(const SceneDescription& scene, int frame);

    /// The same with the largest file of each sequence of a volume: what is chosen from it is the
    /// same for every frame, and for every part of a sequence. Throws Error{Input} where a sequence
    /// has no file.
    SceneDescription atLargest(const SceneDescription& scene, int frame);

private:
    const std::vector<int>& onDisk(const std::string& pattern);
    std::map<std::string, std::vector<int>> onDisk_;
};

}  // namespace woodcock::scene
