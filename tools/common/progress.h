// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "woodcock/render/session.h"

namespace woodcock::tool {

/// Bars and JSON go to stderr; lines for farms to stdout: "ALF_PROGRESS 42%" as Tractor and HQueue
/// read it, "openjd_progress: 42.0" as Open Job Description has it.
enum class ProgressStyle { None, Bar, Json, Alfred, OpenJd };

/// "auto", "bar", "json", "alfred", "openjd" or "none"; auto is a bar where stderr is a terminal,
/// none elsewhere.
ProgressStyle progressStyle(const std::string& name);

/// Where a render stands among the frames of a sequence.
struct FramePlace {
    int frame = 0;
    std::size_t index = 0, count = 1;               ///< of those that are drawn, from 0
    std::chrono::steady_clock::time_point start{};  ///< of the first

    /// Of all frames, where `fraction` of this one is done.
    double doneOfAll(double fraction) const;
    double secondsLeftOfAll(double fraction) const;  ///< an estimate; infinite: unknown
};

/// Renders, shows how far it is, and stops early where interrupted(). `place` is that of a frame;
/// absent: it is no sequence.
render::RenderResult renderWithProgress(const render::Scene& scene,
                                        const render::RenderSettings& settings, ProgressStyle style,
                                        const std::optional<FramePlace>& place = {},
                                        render::Checkpoints checkpoints = {});

/// Prints lines for farms, on stdout, each where the percents have grown.
class FarmLines {
public:
    explicit FarmLines(ProgressStyle style) : style_(style) {}

    /// `fraction` of all the work, and what is being done.
    void update(double fraction, std::string_view doing = {});

private:
    ProgressStyle style_;
    int told_ = -1;  // percent
    std::string doing_;
};

/// Shows how other work goes on, on stderr, no more often than can be read.
class ProgressBar {
public:
    /// `name` is the event's in JSON: {"event": "bake", "fraction": 0.5, ...}.
    ProgressBar(ProgressStyle style, std::string name) : style_(style), name_(std::move(name)) {}
    ~ProgressBar() { clear(); }
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// `doing`: what is being done, behind the bar.
    void update(double fraction, std::string_view doing = {});
    void clear() const;  ///< wipes the bar

private:
    ProgressStyle style_;
    std::string name_;
    FarmLines lines_{style_};
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), shown_{};
};

/// "noise 1.25 %", or "noise unknown" where it is infinite.
std::string noiseText(double noise);

/// complete, time-limit, noise-reached or interrupted.
std::string stopReasonName(render::StopReason reason);

}  // namespace woodcock::tool
