// SPDX-License-Identifier: Apache-2.0
#include "tools/render/quality_auto.h"

#include <spdlog/spdlog.h>

#include <cmath>

#include "tools/common/interrupt.h"
#include "tools/common/progress.h"
#include "tools/common/render_command.h"
#include "woodcock/base/error.h"
#include "woodcock/trade/trade.h"

namespace woodcock::tool {

namespace {

constexpr double pilotShare = 0.1, longestPilot = 30, noisePilot = 15;

/// What a choice is made by: the time that is left, or an error.
struct Goal {
    std::optional<double> seconds;
    double error = 0;  ///< relMSE

    std::optional<trade::Winner> best(const std::vector<trade::TradeModel>& models) const {
        return seconds ? trade::bestAt(models, *seconds) : trade::fastestTo(models, error);
    }
    /// Of a model: "relMSE 1.2e-04 in 54 s".
    std::string expected(const trade::TradeModel& model) const {
        if (seconds) {
            const auto e = model.errorAt(*seconds);
            return e ? fmt::format("relMSE {:.2g} in {}", e->value, formatDuration(*seconds))
                     : "no sample in time";
        }
        const auto t = model.secondsTo(error);
        return t ? fmt::format("relMSE {:.2g} in {}", error, formatDuration(t->value))
                 : "more bias than that";
    }
};

/// The command with the choice in the place of --quality auto.
std::string repeated(std::string command, const trade::Candidate& candidate, bool endless) {
    for (const std::string word : {" --quality auto", " --quality=auto"})
        if (const std::size_t at = command.find(word); at != std::string::npos)
            command.replace(at, word.size(), optionsOf(candidate));
    return command + (endless ? fmt::format(" --spp {}", endlessSamples) : "");
}

trade::ParseScene parser(const RenderOptions& options) {
    return [&options](const std::vector<std::string>& more) {
        SceneInput input = options.sceneInput();
        input.overrides.insert(input.overrides.end(), more.begin(), more.end());
        return parseInput(input);
    };
}

/// Absent where interrupted; nothing in it where the budget was too small.
std::optional<trade::TradeResult> measure(const scene::SceneDescription& scene,
                                          const RenderOptions& options, double budget) {
    ProgressBar progress(
        options.reports.quiet ? ProgressStyle::None : progressStyle(options.reports.progress),
        "choose");
    trade::TradeSettings settings;
    settings.budget = budget;
    settings.threads = options.threads.value_or(0);
    settings.seed = scene.render.seed;
    settings.extent = trade::Extent::Few;
    settings.denoises = scene.render.timeLimit > 0 && !options.denoise;
    settings.onProgress = [&](double fraction, const std::string&) {
        progress.update(fraction);
        return !interrupted();
    };
    try {
        return trade::runTrade(scene, parser(options), {}, settings);
    } catch (const Error& e) {
        if (e.kind() != ErrorKind::Usage) throw;
        spdlog::debug("{}", e.what());
        return trade::TradeResult();
    }
}

}  // namespace

bool chooseQuality(scene::SceneDescription& scene, const RenderOptions& options,
                   const std::string& commandLine) {
    const trade::Stopwatch watch;
    scene::RenderDescription& render = scene.render;
    const double limit = render.timeLimit;
    const double budget = limit > 0 ? std::min(pilotShare * limit, longestPilot) : noisePilot;
    const std::optional<trade::TradeResult> result = measure(scene, options, budget);
    if (!result) return false;

    trade::Candidate chosen{"final", "final", {}};
    double allowed = render.noise;
    double denoising = 0;  // seconds at the end
    // --noise leaves plain background out, and relMSE is a mean over all of the picture.
    const double share = result->reference.noiseShare;
    Goal goal{std::nullopt, render.noise * render.noise / share};
    if (limit > 0) goal.seconds = std::max(0.5 * limit, limit - watch.seconds());
    std::vector<trade::TradeModel> models;
    for (const trade::CandidateResult& c : result->candidates) models.push_back(c.model.careful());
    if (const auto winner = goal.best(models)) {
        const trade::TradeModel& model = models[winner->best];
        chosen = result->candidates[winner->best].candidate;
        denoising = result->candidates[winner->best].denoiseSeconds;
        if (limit <= 0) allowed = std::sqrt(share * (goal.error - model.biasError()));
        spdlog::info(
            "'{}' is expected to reach {}, '{}' {} (bias counted with two standard errors; "
            "measured "
            "in {})",
            chosen.name, goal.expected(model), result->candidates.front().candidate.name,
            goal.expected(models.front()), formatDuration(result->seconds));
    } else {
        spdlog::info("there was no time to measure what choices bring here: quality 'final'");
    }
    const bool endless = !options.spp;
    spdlog::info("the same again: {}", repeated(commandLine, chosen, endless));

    scene = trade::withChoices(scene, parser(options)(chosen.overrides()));
    // Another denoising than was measured: what options say, or none, as noise is that before it.
    if (options.denoise)
        scene.render.denoise = *options.denoise ? scene::Denoise::Always : scene::Denoise::Never;
    else if (limit <= 0)
        scene.render.denoise = scene::Denoise::Never;
    if (endless) scene.render.spp = endlessSamples;
    if (limit > 0)
        scene.render.timeLimit = std::max(0.5 * limit, limit - watch.seconds() - denoising);
    scene.render.noise = allowed;
    return true;
}

}  // namespace woodcock::tool
