// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "tools/render/options.h"
#include "woodcock/image/film_state.h"
#include "woodcock/image/outputs.h"
#include "woodcock/render/session.h"

namespace woodcock::tool {

/// Where the checkpoint of a picture with these files lies: NAME.checkpoint.exr beside the first
/// EXR, or else the first picture; of none, beside the mattes or deep pixels. Nowhere for pipes,
/// devices and no files: empty.
std::filesystem::path checkpointFile(const scene::OutputDescription& output);

/// The checkpoint of one picture, from which its render goes on and into which it is written.
class Checkpoint {
public:
    /// `picture`: the pixels of which the settings' crop is a part. `file`: that of
    /// checkpointFile(). `facts` as of factsOf(). The references must stay.
    Checkpoint(const RenderOptions& options, const render::RenderSettings& settings,
               image::Film::Window picture, const image::Outputs& outputs,
               std::filesystem::path file, image::StateFacts facts,
               std::function<image::RenderMetadata(const render::RenderState&)> metadata);

    /// For render(): goes on from the file with --resume, if there is one. Throws Error{Input}
    /// where that is damaged or of another render.
    render::Checkpoints hooks();
    /// What EXR files keep, for merging.
    const image::StateFacts& facts() const { return facts_; }

    /// Writes what was interrupted, where checkpoints are asked for.
    void keep(const render::RenderResult& result);
    /// The picture is done: no checkpoint is left.
    void remove() const;

private:
    bool active() const { return options_.keepsCheckpoint() || written_; }
    std::optional<render::RenderState> read() const;
    bool isDue();
    bool write(const render::RenderState& state);

    const RenderOptions& options_;
    const render::RenderSettings& settings_;
    const image::Film::Window picture_;
    const image::Outputs& outputs_;
    const std::filesystem::path file_;
    const image::StateFacts facts_;
    const std::function<image::RenderMetadata(const render::RenderState&)> metadata_;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
    bool written_ = false;
};

}  // namespace woodcock::tool
