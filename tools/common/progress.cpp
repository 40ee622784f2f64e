// SPDX-License-Identifier: Apache-2.0
#include "tools/common/progress.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/common/interrupt.h"
#include "tools/common/print.h"
#include "woodcock/base/parse.h"

namespace woodcock::tool {

namespace {

using Json = nlohmann::ordered_json;

void printLine(const Json& json) { printProgress("{}\n", json.dump()); }

std::string bar(double fraction) {
    constexpr int width = 30;
    const int full = static_cast<int>(fraction * width);
    return fmt::format("[{:#<{}}{:.<{}}]", "", full, "", width - full);
}

/// What is told of a render on its way.
class RenderProgressReport {
public:
    explicit RenderProgressReport(ProgressStyle style) : style_(style) {}

    void start(const render::RenderSettings& settings) {
        if (style_ == ProgressStyle::Json)
            printLine({{"event", "start"},
                       {"width", settings.width},
                       {"height", settings.height},
                       {"first_sample", settings.firstSample},
                       {"end_sample", settings.endSample},
                       {"seed", settings.seed}});
    }

    void update(const render::RenderProgress& progress) {
        spdlog::trace("render: {:.1f} %, {} samples a pixel, {} left", 100 * progress.fraction,
                      progress.samples, formatDuration(progress.secondsLeft));
        if (style_ == ProgressStyle::Json) {
            printLine({{"event", "progress"},
                       {"fraction", progress.fraction},
                       {"seconds", progress.seconds},
                       {"seconds_left", progress.secondsLeft},
                       {"samples", progress.samples},
                       {"noise", progress.noise}});
        } else if (style_ == ProgressStyle::Bar) {
            const std::string noise =
                std::isfinite(progress.noise) ? ", " + noiseText(progress.noise) : "";
            // Carriage return, and erase to the end of the line.
            printProgress("\r{} {:3.0f} %, {} left, {} samples{}\x1b[K", bar(progress.fraction),
                          100 * progress.fraction, formatDuration(progress.secondsLeft),
                          progress.samples, noise);
        }
    }

    void finish(const render::RenderResult& result) {
        if (style_ == ProgressStyle::Json)
            printLine({{"event", "done"},
                       {"reason", stopReasonName(result.reason)},
                       {"seconds", result.seconds},
                       {"end_sample", result.endSample},
                       {"noise", result.film.noise()},
                       {"non_finite", result.film.nonFiniteCount()}});
        else if (style_ == ProgressStyle::Bar)
            printProgress("\r\x1b[K");
    }

private:
    ProgressStyle style_;
};

}  // namespace

ProgressStyle progressStyle(const std::string& name) {
    if (name == "bar") return ProgressStyle::Bar;
    if (name == "json") return ProgressStyle::Json;
    if (name == "auto" && isatty(STDERR_FILENO)) return ProgressStyle::Bar;
    return ProgressStyle::None;
}

render::RenderResult renderWithProgress(const render::Scene& scene,
                                        const render::RenderSettings& settings, ProgressStyle style,
                                        render::Checkpoints checkpoints) {
    RenderProgressReport report(style);
    report.start(settings);
    render::RenderResult result = render::render(
        scene, settings,
        [&](const render::RenderProgress& now) {
            report.update(now);
            return !interrupted();
        },
        std::move(checkpoints));
    report.finish(result);
    return result;
}

void ProgressBar::clear() const {
    if (style_ == ProgressStyle::Bar) printProgress("\r\x1b[K");
}

void ProgressBar::update(double fraction, std::string_view doing) {
    const auto now = std::chrono::steady_clock::now();
    constexpr std::chrono::milliseconds pause(200);
    if (now - shown_ < pause) return;
    shown_ = now;
    spdlog::trace("{}: {:.1f} %", name_, 100 * fraction);
    if (style_ == ProgressStyle::None) return;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const double left = fraction > 0 ? seconds * (1 - fraction) / fraction : 0;
    if (style_ == ProgressStyle::Json) {
        printLine({{"event", name_},
                   {"fraction", fraction},
                   {"seconds", seconds},
                   {"seconds_left", left}});
        return;
    }
    printProgress("\r{} {} {:3.0f} %, {} left{}{}\x1b[K", name_, bar(fraction), 100 * fraction,
                  formatDuration(left), doing.empty() ? "" : ": ", doing);
}

std::string noiseText(double noise) {
    return std::isfinite(noise) ? fmt::format("noise {:.2f} %", 100 * noise) : "noise unknown";
}

std::string stopReasonName(render::StopReason reason) {
    switch (reason) {
        case render::StopReason::Complete:
            return "complete";
        case render::StopReason::TimeLimit:
            return "time-limit";
        case render::StopReason::NoiseReached:
            return "noise-reached";
        case render::StopReason::Interrupted:
            return "interrupted";
    }
    return {};
}

}  // namespace woodcock::tool
