// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "woodcock/render/session.h"

namespace woodcock::tool {

enum class ProgressStyle { None, Bar, Json };

/// "auto", "bar", "json" or "none"; auto is a bar where stderr is a terminal, none elsewhere.
ProgressStyle progressStyle(const std::string& name);

/// Renders, shows on stderr how far it is, and stops early where interrupted().
render::RenderResult renderWithProgress(const render::Scene& scene,
                                        const render::RenderSettings& settings, ProgressStyle style,
                                        render::Checkpoints checkpoints = {});

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
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), shown_{};
};

/// "noise 1.25 %", or "noise unknown" where it is infinite.
std::string noiseText(double noise);

/// complete, time-limit, noise-reached or interrupted.
std::string stopReasonName(render::StopReason reason);

}  // namespace woodcock::tool
