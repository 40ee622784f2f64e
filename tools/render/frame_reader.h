// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <optional>
#include <utility>
#include <vector>

#include "woodcock/scene/animation.h"
#include "woodcock/scene/defaults.h"
#include "woodcock/scene/frame_files.h"
#include "woodcock/scene/load.h"

namespace woodcock::tool {

/// All files that a picture goes into.
std::vector<std::filesystem::path> imagesOf(const scene::OutputDescription& output);

/// What a frame is drawn from.
struct LoadedFrame {
    scene::SceneDescription description;
    scene::LoadedScene loaded;
    double seconds = 0;  ///< that it took
};

/// The scenes of the frames of a sequence. What two frames share is loaded once, and a frame may be
/// read while the one before it is drawn.
class FrameReader {
public:
    /// `describe`: the scene of a frame, where each has a scene file of its own; what such a scene
    /// leaves open is chosen for it alone.
    FrameReader(scene::SceneDescription sequence, scene::Look look,
                std::function<scene::SceneDescription(int frame)> describe = {})
        : sequence_(std::move(sequence)), look_(look), describe_(std::move(describe)) {}

    /// The scene of all frames; what is chosen for all is set here. Not while a frame is read.
    scene::SceneDescription& sequence() { return sequence_; }
    const scene::SceneDescription& sequence() const { return sequence_; }
    /// Nothing is open any more: frames are drawn as they are described. Before, names of grids are
    /// found in each frame's files.
    void setComplete() { complete_ = true; }

    /// The scene as it is in a frame: its files, and its animated values. Throws Error{Input} where
    /// it has no file.
    scene::SceneDescription at(int frame) {
        return files_.at(scene::atFrame(describe_ ? describe_(frame) : sequence_, frame), frame);
    }
    /// See FrameFiles.
    scene::SceneDescription atLargest(int frame) {
        return files_.atLargest(scene::atFrame(sequence_, frame), frame);
    }

    /// Loads what a frame, or the largest, describes.
    scene::LoadedScene load(const scene::SceneDescription& scene) {
        return scene::loadScene(scene, &cache_);
    }
    void loadChosen(const scene::SceneDescription& scene, scene::LoadedScene& loaded) {
        scene::loadChosen(scene, loaded, &cache_);
    }

    /// Begins to read a frame, in a thread of its own. Nothing where memory may not hold another
    /// scene like `present`.
    void readAhead(int frame, const scene::LoadedScene& present);

    /// The frame: the one that was read ahead, or else it is read now. Throws Error{Input}.
    LoadedFrame take(int frame);

private:
    LoadedFrame read(int frame);

    scene::SceneDescription sequence_;
    scene::Look look_;
    std::function<scene::SceneDescription(int frame)> describe_;
    scene::FrameFiles files_;
    scene::LoadCache cache_;
    bool complete_ = false;
    int ahead_ = 0;
    std::future<LoadedFrame> next_;  // the last member: it ends before what it reads with
};

/// Memory of the grids of a scene.
double bytesOf(const scene::LoadedScene& scene);

/// Those of `frames` that are drawn, and why others are not.
struct FramePlan {
    std::vector<int> drawn, skipped;  ///< there already
    /// Frames without a file, by what is wrong with them.
    std::vector<std::pair<std::string, std::vector<int>>> without;

    std::vector<int> failed() const;
};
/// `skipExisting`: leave out those whose outputs are there.
FramePlan planFrames(const std::vector<int>& frames, FrameReader& reader, bool skipExisting);

/// Whether something is open in a scene that depends on what its files hold, beside names of grids.
bool leavesChoices(const scene::SceneDescription& scene);

}  // namespace woodcock::tool
