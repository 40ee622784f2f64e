// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "woodcock/render/session.h"

namespace woodcock::tool {

enum class ProgressStyle { None, Bar, Json };

/// "auto", "bar", "json" or "none"; auto is a bar where stderr is a terminal, none elsewhere.
ProgressStyle progressStyle(const std::string& name);

/// Shows how a render goes on, on stderr.
class Progress {
public:
    explicit Progress(ProgressStyle style) : style_(style) {}

    void start(const RenderSettings& settings);
    void update(const RenderProgress& progress);
    void finish(const RenderResult& result);

private:
    ProgressStyle style_;
};

/// "noise 1.25 %", or "noise unknown" where it is infinite.
std::string noiseText(double noise);

/// complete, time-limit, noise-reached or interrupted.
std::string stopReasonName(StopReason reason);

}  // namespace woodcock::tool
