// SPDX-License-Identifier: Apache-2.0
#include "tools/common/progress.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "tools/common/interrupt.h"
#include "tools/common/print.h"
#include "woodcock/base/parse.h"
#include "woodcock/base/printable.h"

namespace woodcock::tool {

namespace {

using Json = nlohmann::ordered_json;

void printLine(const Json& json) { printProgress("{}\n", json.dump()); }

std::string bar(double fraction) {
    constexpr int width = 30;
    const int full = static_cast<int>(fraction * width);
    return fmt::format("[{:#<{}}{:.<{}}]", "", full, "", width - full);
}

bool isForFarms(ProgressStyle style) {
    return style == ProgressStyle::Alfred || style == ProgressStyle::OpenJd;
}

/// What is told of a render on its way.
class RenderProgressReport {
public:
    RenderProgressReport(ProgressStyle style, const std::optional<FramePlace>& place)
        : style_(style), place_(place), lines_(style) {}

    void start(const render::RenderSettings& settings) {
        if (style_ != ProgressStyle::Json) return;
        Json line{{"event", "start"}};
        addPlace(line, 0);
        line.update({{"width", settings.width},
                     {"height", settings.height},
                     {"first_sample", settings.firstSample},
                     {"end_sample", settings.endSample},
                     {"seed", settings.seed}});
        printLine(line);
    }

    void update(const render::RenderProgress& progress) {
        spdlog::trace("render: {:.1f} %, {} samples a pixel, {} left", 100 * progress.fraction,
                      progress.samples, formatDuration(progress.secondsLeft));
        if (isForFarms(style_)) {
            lines_.update(place_ ? place_->doneOfAll(progress.fraction) : progress.fraction,
                          place_ ? frameText() : "rendering");
        } else if (style_ == ProgressStyle::Json) {
            Json line{{"event", "progress"},         {"fraction", progress.fraction},
                      {"seconds", progress.seconds}, {"seconds_left", progress.secondsLeft},
                      {"samples", progress.samples}, {"noise", progress.noise}};
            addPlace(line, progress.fraction);
            printLine(line);
        } else if (style_ == ProgressStyle::Bar) {
            const std::string noise =
                std::isfinite(progress.noise) ? ", " + noiseText(progress.noise) : "";
            // Carriage return, and erase to the end of the line.
            printProgress("\r{}{} {:3.0f} %, {} left{}, {} samples{}\x1b[K",
                          place_ ? frameText() + " " : "", bar(progress.fraction),
                          100 * progress.fraction, formatDuration(progress.secondsLeft),
                          leftOfAll(progress.fraction), progress.samples, noise);
        }
    }

    void finish(const render::RenderResult& result) {
        if (style_ == ProgressStyle::Json) {
            Json line{{"event", "done"},
                      {"reason", stopReasonName(result.reason)},
                      {"seconds", result.seconds},
                      {"end_sample", result.endSample},
                      {"noise", result.film.noise()},
                      {"non_finite", result.film.nonFiniteCount()}};
            addPlace(line, 1);
            printLine(line);
        } else if (style_ == ProgressStyle::Bar) {
            printProgress("\r\x1b[K");
        }
    }

private:
    std::string frameText() const {
        return fmt::format("frame {} ({} of {})", place_->frame, place_->index + 1, place_->count);
    }
    std::string leftOfAll(double fraction) const {
        if (!place_) return {};
        const double left = place_->secondsLeftOfAll(fraction);
        return std::isfinite(left) ? fmt::format(", {} for all", formatDuration(left)) : "";
    }
    void addPlace(Json& line, double fraction) const {
        if (!place_) return;
        line.update({{"frame", place_->frame},
                     {"frame_index", place_->index},
                     {"frames", place_->count},
                     {"fraction_of_all", place_->doneOfAll(fraction)},
                     {"seconds_left_of_all", place_->secondsLeftOfAll(fraction)}});
    }

    ProgressStyle style_;
    const std::optional<FramePlace>& place_;
    FarmLines lines_;
};

}  // namespace

ProgressStyle progressStyle(const std::string& name) {
    if (name == "bar") return ProgressStyle::Bar;
    if (name == "json") return ProgressStyle::Json;
    if (name == "alfred") return ProgressStyle::Alfred;
    if (name == "openjd") return ProgressStyle::OpenJd;
    if (name == "auto" && isatty(STDERR_FILENO)) return ProgressStyle::Bar;
    return ProgressStyle::None;
}

double FramePlace::doneOfAll(double fraction) const {
    return (static_cast<double>(index) + fraction) / static_cast<double>(count);
}

double FramePlace::secondsLeftOfAll(double fraction) const {
    const double done = doneOfAll(fraction);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    return done > 0 ? time.count() * (1 - done) / done : std::numeric_limits<double>::infinity();
}

void FarmLines::update(double fraction, std::string_view doing) {
    const int percent = static_cast<int>(std::floor(100 * fraction + 1e-9));
    if (style_ == ProgressStyle::OpenJd && !doing.empty() && doing != doing_) {
        doing_ = doing;
        printData(fmt::format("openjd_status: {}\n", printable(doing)));
    }
    if (percent <= told_) return;
    told_ = percent;
    if (style_ == ProgressStyle::Alfred) printData(fmt::format("ALF_PROGRESS {}%\n", percent));
    if (style_ == ProgressStyle::OpenJd)
        printData(fmt::format("openjd_progress: {:.1f}\n", double(percent)));
    std::fflush(stdout);
}

render::RenderResult renderWithProgress(const render::Scene& scene,
                                        const render::RenderSettings& settings, ProgressStyle style,
                                        const std::optional<FramePlace>& place,
                                        render::Checkpoints checkpoints) {
    RenderProgressReport report(style, place);
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
    if (isForFarms(style_)) return lines_.update(fraction, doing.empty() ? name_ : doing);
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
