// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "woodcock/image/deep_state.h"
#include "woodcock/image/film_state.h"
#include "woodcock/render/session.h"

namespace woodcock::render {

/// Why a state is as it is: what a part of a picture that is to be merged promises.
enum class Ending {
    Complete,   ///< it has all samples that were asked for
    Limited,    ///< a limit of time or noise ended it
    Unfinished  ///< it was interrupted, or still goes on
};
Ending endingOf(StopReason reason);

/// A render's state as files keep it. Refers to the state that it is made of.
class SavedState {
public:
    /// `facts` say what cannot be seen here: at least "scene" and "files", the digests that tell
    /// scenes apart. `picture` are the pixels of which the state is a part.
    SavedState(const RenderState& state, const RenderSettings& settings,
               image::Film::Window picture, Ending ending, image::StateFacts facts);
    SavedState(const SavedState&) = delete;
    SavedState& operator=(const SavedState&) = delete;

    const image::FilmState& filmState() const { return saved_; }

private:
    std::vector<std::uint64_t> drawn_;
    std::vector<SamplePlan::Weight> plan_;
    std::optional<image::DeepState> deep_;
    image::FilmState saved_;
};

/// What the file keeps. Throws Error{Input} where that is damaged, or not of a render.
RenderState readState(const image::StateFile& file);
Ending endingOf(const image::StateFile& file);
/// Of its mattes, without owners.
std::vector<image::MatteLayer> matteLayersIn(const image::StateFile& file);
/// The pixels of which the file's are a part.
image::Film::Window pictureOf(const image::StateFile& file);

/// Throws Error{Input} unless a render with these settings and facts, as SavedState has them, may
/// go on from the file to the bits that it would have had.
void checkGoesOn(const image::StateFile& file, const RenderSettings& settings,
                 image::Film::Window picture, const image::StateFacts& facts);

}  // namespace woodcock::render
