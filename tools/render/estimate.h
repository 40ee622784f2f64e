// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/render/scene.h"
#include "woodcock/render/session.h"

namespace woodcock::tool {

/// A number, and how far the truth may lie from it: 95 % confidence, as a half width.
struct Guess {
    double value = 0, error = 0;
};

/// What was measured of a frame, or of the one picture.
struct FrameTrial {
    std::optional<int> frame = {};
    double loadSeconds = 0;        ///< until the scene stands
    double renderSeconds = 0;      ///< of all its samples
    double standardError = 0;      ///< of renderSeconds
    double samples = 0;            ///< of each pixel, that it takes
    double sceneBytes = 0;         ///< memory of its grids
    std::uintmax_t fileBytes = 0;  ///< of the files of its volumes
    double seconds() const { return loadSeconds + renderSeconds; }
};

/// Renders a few samples of a smaller picture, several times, and scales their time up: to the
/// pixels of `settings`, and to the samples that its range, its noise or its time limit ask for.
/// Fills in what is measured of rendering. False where `goOn` said so.
bool measureRender(const render::Scene& scene, const render::RenderSettings& settings,
                   FrameTrial& trial, const std::function<bool()>& goOn);

/// So many times a block of samples is measured; the first block only warms up.
inline constexpr int measuredBlocks = 5;

/// Seconds that a picture of so many pixels takes, and their standard error, where they grow with
/// the pixels: from those that measure(side) says of two small pictures, square, of this side.
Guess timeByPixels(const std::function<double(int side)>& measure, double pixels);

struct RenderEstimate {
    Guess frame = {}, all = {};  ///< seconds; `frame` is the mean of a frame
    Guess denoising = {};        ///< seconds, of a frame; they are part of these
    Guess memory = {};           ///< bytes, with the frame that is read ahead
    std::vector<FrameTrial> trials = {};
    std::size_t frames = 1;
};

/// `trials` are evenly spread over `frames`, and each one more of the error's sources: how a
/// block's time varies, and, where not all were tried, how frames do. `fixedBytes`: memory that
/// does not depend on the frame. `largestFile`: bytes of the volumes of the largest frame.
/// `denoising`: of each frame, with its standard error.
RenderEstimate estimateAll(std::vector<FrameTrial> trials, std::size_t frames, double fixedBytes,
                           std::uintmax_t largestFile, Guess denoising = {});

/// At most `most` of the frames, evenly spread.
std::vector<int> spreadFrames(const std::vector<int>& frames, std::size_t most);

std::string estimateText(const RenderEstimate& estimate);
nlohmann::ordered_json estimateJson(const RenderEstimate& estimate);

}  // namespace woodcock::tool
