// SPDX-License-Identifier: Apache-2.0
#include "tools/render/estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "woodcock/base/frame_range.h"
#include "woodcock/base/memory.h"
#include "woodcock/base/parse.h"
#include "woodcock/base/statistics.h"
#include "woodcock/compare/student_t.h"

namespace woodcock::tool {

namespace {

constexpr double fewPixels = 20000;
constexpr double blockSeconds = 0.15;
constexpr double confidence = 0.95;

/// Standard errors that a number of this many degrees of freedom lies within.
double quantile(double degrees) {
    double low = 0, high = 1000;
    for (int i = 0; i < 60; ++i) {
        const double t = (low + high) / 2;
        (compare::studentTwoSided(t, degrees) > 1 - confidence ? low : high) = t;
    }
    return high;
}

/// The picture with fewer pixels, and how many times fewer.
double shrink(render::RenderSettings& settings) {
    const auto pixelsOf = [](const render::RenderSettings& s) {
        const auto crop = s.crop.value_or(image::Film::Window{0, 0, s.width, s.height});
        return double(crop.width()) * crop.height();
    };
    const double all = pixelsOf(settings);
    const double share = std::min(1.0, std::sqrt(fewPixels / all));
    const auto scaled = [&](int n) {
        return std::max(1, static_cast<int>(std::lround(n * share)));
    };
    if (auto& crop = settings.crop) {
        crop->x0 = static_cast<int>(crop->x0 * share),
        crop->y0 = static_cast<int>(crop->y0 * share);
        crop->x1 = std::max(crop->x0 + 1, static_cast<int>(crop->x1 * share));
        crop->y1 = std::max(crop->y0 + 1, static_cast<int>(crop->y1 * share));
    }
    settings.width = scaled(settings.width), settings.height = scaled(settings.height);
    return all / pixelsOf(settings);
}

/// The samples that a noise takes, from a film of `done` of them: it falls with their root.
double samplesForNoise(const image::Film& film, int done, double noise, double most) {
    const double now = film.noise();
    if (!(noise > 0) || !std::isfinite(now)) return most;
    return std::clamp(done * (now / noise) * (now / noise), 1.0, most);
}

std::string secondsText(const Guess& guess) {
    return fmt::format("{} +- {}", formatDuration(guess.value), formatDuration(guess.error));
}

nlohmann::ordered_json json(const Guess& guess) {
    return {{"value", guess.value}, {"error", guess.error}};
}

}  // namespace

bool measureRender(const render::Scene& scene, const render::RenderSettings& settings,
                   FrameTrial& trial, const std::function<bool()>& goOn) {
    render::RenderSettings small = settings;
    const double times = shrink(small);
    small.adaptive = false;  // adaptive samples are as much work
    small.timeLimit = small.noise = 0;
    const auto block = [&](int first, int count) {
        small.firstSample = first, small.endSample = first + count;
        return render::render(scene, small, [&](const auto&) { return goOn(); });
    };
    const render::RenderResult warm = block(0, 1);
    if (!goOn()) return false;
    const int count =
        std::clamp(static_cast<int>(std::ceil(blockSeconds / std::max(warm.seconds, 1e-4))), 1, 64);
    Moments seconds;
    std::optional<image::Film> film;
    for (int i = 0; i < measuredBlocks; ++i) {
        const render::RenderResult result = block(i * count, count);
        if (!goOn()) return false;
        seconds.add(result.seconds / count);
        film ? film->merge(result.film) : void(film.emplace(result.film));
    }
    trial.samples = samplesForNoise(*film, measuredBlocks * count, settings.noise,
                                    settings.endSample - settings.firstSample);
    const double scale = times * trial.samples;
    trial.renderSeconds = scale * seconds.mean();
    trial.standardError = scale * seconds.standardError();
    if (settings.timeLimit > 0 && trial.renderSeconds > settings.timeLimit)
        trial.renderSeconds = settings.timeLimit, trial.standardError = 0;
    return true;
}

Guess timeByPixels(const std::function<double(int side)>& measure, double pixels) {
    constexpr int small = 96, large = 288, times = 3;
    const auto timed = [&](int side) {
        Moments seconds;
        for (int i = 0; i < times; ++i) seconds.add(measure(side));
        return seconds;
    };
    timed(small);  // warms up
    const Moments first = timed(small), second = timed(large);
    constexpr double from = double(small) * small, to = double(large) * large;
    const double beyond = (pixels - to) / (to - from);
    return {std::max(0.0, second.mean() + beyond * (second.mean() - first.mean())),
            std::hypot((1 + beyond) * second.standardError(), beyond * first.standardError())};
}

RenderEstimate estimateAll(std::vector<FrameTrial> trials, std::size_t frames, double fixedBytes,
                           std::uintmax_t largestFile, Guess denoising) {
    RenderEstimate estimate{.trials = std::move(trials), .frames = frames};
    const auto tried = static_cast<double>(estimate.trials.size());
    const auto all = static_cast<double>(frames);
    Moments seconds, bytesPerByte;
    double within = 0, mostBytes = 0;
    for (const FrameTrial& trial : estimate.trials) {
        seconds.add(trial.seconds());
        within += trial.standardError * trial.standardError / (tried * tried);
        mostBytes = std::max(mostBytes, trial.sceneBytes);
        if (trial.fileBytes > 0)
            bytesPerByte.add(trial.sceneBytes / static_cast<double>(trial.fileBytes));
    }
    const double among = seconds.standardError() * seconds.standardError() * (1 - tried / all);
    const bool each = tried == all;
    const double degrees = each ? measuredBlocks - 1 : std::max(1.0, tried - 1);
    // All frames have the one measurement of denoising, and its error.
    const double error =
        quantile(degrees) * std::sqrt(within + among + denoising.error * denoising.error);
    const double mean = seconds.mean() + denoising.value;
    estimate.frame = {mean, error};
    estimate.all = {all * mean, all * error};
    estimate.denoising = {denoising.value, quantile(degrees) * denoising.error};
    // Grids in memory grow as their files do; the next frame is read beside this one.
    const double largest =
        std::max(mostBytes, bytesPerByte.mean() * static_cast<double>(largestFile));
    const double spread = 2 * std::sqrt(bytesPerByte.variance()) * static_cast<double>(largestFile);
    const double scenes = frames > 1 ? 2 : 1;
    // Allocators and libraries take a tenth more or less.
    constexpr double usual = 0.1;
    estimate.memory = {fixedBytes + scenes * largest,
                       usual * (fixedBytes + scenes * largest) + scenes * spread};
    return estimate;
}

std::vector<int> spreadFrames(const std::vector<int>& frames, std::size_t most) {
    if (frames.size() <= most) return frames;
    std::vector<int> some;
    for (std::size_t i = 0; i < most; ++i)
        some.push_back(frames[(2 * i + 1) * frames.size() / (2 * most)]);
    return some;
}

std::string estimateText(const RenderEstimate& estimate) {
    std::string text;
    if (estimate.frames > 1)
        text += fmt::format("{} frames: {}\na frame:   {}, in the mean\n", estimate.frames,
                            secondsText(estimate.all), secondsText(estimate.frame));
    else
        text += fmt::format("time:   {}\n", secondsText(estimate.frame));
    if (estimate.denoising.value > 0)
        text += fmt::format("denoising takes {} of it\n", secondsText(estimate.denoising));
    text += fmt::format("memory: {} +- {}\n", formatGiB(estimate.memory.value),
                        formatGiB(estimate.memory.error));
    for (const FrameTrial& trial : estimate.trials)
        text += fmt::format("{}{} to load, {} +- {} for {:.0f} samples of each pixel\n",
                            trial.frame ? fmt::format("frame {}: ", *trial.frame) : "",
                            formatDuration(trial.loadSeconds), formatDuration(trial.renderSeconds),
                            formatDuration(quantile(measuredBlocks - 1) * trial.standardError),
                            trial.samples);
    return text +
           "The truth lies within these bounds in about 95 of 100 cases, on a machine as busy as "
           "now. Nothing is written.\n";
}

nlohmann::ordered_json estimateJson(const RenderEstimate& estimate) {
    nlohmann::ordered_json result{{"frames", estimate.frames},
                                  {"seconds", json(estimate.all)},
                                  {"seconds_of_frame", json(estimate.frame)},
                                  {"memory_bytes", json(estimate.memory)},
                                  {"confidence", confidence}};
    if (estimate.denoising.value > 0) result["denoise_seconds"] = json(estimate.denoising);
    result["trials"] = nlohmann::ordered_json::array();
    for (const FrameTrial& trial : estimate.trials) {
        nlohmann::ordered_json one = nlohmann::ordered_json::object();
        if (trial.frame) one["frame"] = *trial.frame;
        one.update({{"load_seconds", trial.loadSeconds},
                    {"render_seconds", trial.renderSeconds},
                    {"standard_error", trial.standardError},
                    {"samples", trial.samples},
                    {"scene_bytes", trial.sceneBytes}});
        result["trials"].push_back(std::move(one));
    }
    return result;
}

}  // namespace woodcock::tool
