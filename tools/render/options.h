// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/common/report_options.h"
#include "tools/common/scene_input.h"
#include "woodcock/base/parse.h"
#include "woodcock/scene/description.h"

namespace woodcock::tool {

/// What the command line of `woodcock render` says; what is absent is left to the scene.
struct RenderOptions {
    std::vector<std::filesystem::path> inputs, outputs;
    std::filesystem::path writeScene, stats;
    std::vector<int> frames;  ///< empty: one picture, without a number
    bool skipExisting = false, estimate = false;

    std::optional<ImageSize> size;
    std::optional<PixelRectangle> crop;
    std::optional<int> spp;
    std::optional<SampleRange> samples;
    std::optional<TileNumber> tile;
    bool mergeable = false;
    std::optional<double> checkpoint;  ///< seconds between two
    bool resume = false;
    std::optional<std::uint64_t> seed;
    std::optional<double> timeLimit, noise;
    std::optional<bool> adaptive, denoise;
    std::optional<std::string> quality;  ///< one of qualityNames, or "auto"
    std::optional<int> threads;
    std::vector<std::string> overrides;
    std::optional<std::pair<double, double>> sun;  ///< elevation, azimuth; degrees
    std::optional<double> orbit;                   ///< degrees
    std::optional<double> frame;
    std::string shutter;  ///< as a scene file has it; empty: its own
    std::optional<grid::Storage> storage;
    bool repair = false, overlay = false, plain = false;

    std::optional<std::string> display, view, look;
    std::optional<double> exposure;
    std::filesystem::path ocio;
    std::vector<std::string> layers, mattes;
    std::filesystem::path mattesFile, deep;
    std::optional<double> deepError;
    bool half = false, multipart = false, mkdir = false;

    ReportOptions reports;

    void addTo(CLI::App& command);
    /// The scene, of the quality that is asked for unless that is to be chosen.
    SceneInput sceneInput() const;
    scene::Look choicesLook() const { return plain ? scene::Look::Plain : scene::Look::Picture; }
    /// Whether nobody says how long a picture of a file alone takes, or how good it has to be.
    bool leavesSamplesOpen(const scene::SceneDescription& scene) const;
    bool choosesQuality() const { return quality == "auto"; }
    /// Whether names of volumes may hold a place for a frame's number.
    bool takesFrames() const { return !frames.empty() || !rendersImages(); }
    /// Throws Error{Usage} where options contradict each other.
    void check() const;
    /// Throws Error{Usage} where an option is for another kind of file than those to be written.
    void checkFor(const std::vector<std::filesystem::path>& files) const;
    bool keepsCheckpoint() const { return checkpoint || resume; }
    /// Whether EXR files keep their sums, for merging.
    bool keepsSums() const { return mergeable || samples || tile; }
    /// What is drawn is no picture yet, but goes into one.
    bool drawsPart() const { return samples || tile; }
    /// Or only saves the scene.
    bool rendersImages() const { return writeScene.empty() || !outputs.empty(); }
};

}  // namespace woodcock::tool
