// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/needs_cost.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "woodcock/base/error.h"
#include "woodcock/base/parse.h"
#include "woodcock/base/statistics.h"
#include "woodcock/render/preparation.h"

namespace woodcock::trade {
namespace {

constexpr std::array<bool render::Needs::*, needNames.size()> members{
    &render::Needs::chromatic,     &render::Needs::scattering,  &render::Needs::emission,
    &render::Needs::lightSampling, &render::Needs::localLights, &render::Needs::surfaces};

constexpr int fewestPairs = 3, usualPairs = 12;
/// Seconds of one run: long beside the clock's ticks, short beside other work of the machine.
constexpr double shortestRun = 0.01, longestRun = 0.3;
constexpr int largestSide = 64;

bool render::Needs::*memberOf(Need need) { return members[static_cast<std::size_t>(need)]; }

struct Run {
    double seconds = 0;   ///< for each sample
    double mean = 0;      ///< of the picture
    double variance = 0;  ///< of a sample, mean over its pixels
    render::RenderResult result;
};

/// A scene, and what its renders share.
struct Prepared {
    const render::Scene& scene;
    std::shared_ptr<const render::Preparation> preparation = {};
};

Run run(const Prepared& of, const render::RenderSettings& settings) {
    const double start = processorSeconds();
    Run r{0, 0, 0, render::renderPrepared(of.scene, settings, of.preparation)};
    r.seconds = (processorSeconds() - start) / settings.endSample;
    for (int y = 0; y < settings.height; ++y)
        for (int x = 0; x < settings.width; ++x) {
            const double error = r.result.film.standardError(x, y).mean();
            r.mean += r.result.film.radiance(x, y).mean();
            r.variance += error * error * settings.endSample;
        }
    r.mean /= settings.width * settings.height;
    r.variance /= settings.width * settings.height;
    return r;
}

double wallSecondsOf(const render::Scene& scene, const render::RenderSettings& settings) {
    const double start = wallSeconds();
    run({scene}, settings);
    return wallSeconds() - start;
}

/// The same view, small, one sample of each pixel.
render::RenderSettings smallView(render::RenderSettings s) {
    const double shrink = std::min(1.0, double{largestSide} / std::max(s.width, s.height));
    s.width = std::max(1, static_cast<int>(std::lround(s.width * shrink)));
    s.height = std::max(1, static_cast<int>(std::lround(s.height * shrink)));
    s.crop.reset();
    s.threads = 1;
    s.timeLimit = s.noise = 0;
    s.adaptive = false;
    s.firstSample = 0, s.endSample = 1;
    return s;
}

/// As many samples as one run of about `seconds` of wall clock takes.
void lengthen(const render::Scene& scene, render::RenderSettings& s, double seconds) {
    while (s.endSample < (1 << 20)) {
        const double taken = wallSecondsOf(scene, s);
        if (taken >= seconds / 2) break;
        s.endSample *= std::clamp(static_cast<int>(seconds / std::max(taken, 1e-6)), 2, 16);
    }
}

NeedCost measure(const render::Scene& scene, Need need, render::RenderSettings settings,
                 double seconds, double precision) {
    const render::Scene forced = forceNeed(scene, need);
    const double end = wallSeconds() + seconds;
    NeedCost cost{.need = need, .sameBits = true};
    std::vector<double> with, without, ratios, variances;
    Moments difference;
    const std::uint64_t seed = settings.seed;
    const auto prepared = [&](const render::Scene& of) {
        const auto preparation = std::make_shared<const render::Preparation>(
            of, settings.width, settings.height, settings.approximations);
        preparation->fill(settings.threads, [&] { return wallSeconds() < end; });
        return Prepared{of, preparation};
    };
    const Prepared needing = prepared(forced), plain = prepared(scene);
    run(needing, settings);
    while (true) {
        settings.seed = seed + static_cast<std::uint64_t>(cost.pairs);
        // A B, B A, A B: a drift of the machine affects both.
        const bool swap = cost.pairs % 2;
        const Run first = run(swap ? needing : plain, settings);
        const Run second = run(swap ? plain : needing, settings);
        const Run &a = swap ? second : first, &b = swap ? first : second;
        without.push_back(a.seconds), with.push_back(b.seconds);
        ratios.push_back(b.seconds / a.seconds);
        // The variance of a single sample is unknown, and a variance of zero has no ratio.
        if (a.variance > 0 && std::isfinite(a.variance))
            variances.push_back(b.variance / a.variance);
        cost.sameBits &= sameBits(a.result.film, b.result.film);
        if (a.mean > 0) difference.add(b.mean / a.mean - 1);
        ++cost.pairs;
        cost.ratio = medianOf(ratios);
        const bool known = cost.pairs >= usualPairs && cost.ratio.se < precision * cost.ratio.value;
        if (known || (cost.pairs >= fewestPairs && wallSeconds() > end)) break;
    }
    cost.variance = variances.empty() ? Measured{1, 0} : medianOf(variances);
    cost.with = medianOf(with), cost.without = medianOf(without);
    cost.difference = {difference.mean(), difference.standardError()};
    return cost;
}

}  // namespace

bool sameBits(const image::Film& a, const image::Film& b) {
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x)
            if (a.radiance(x, y) != b.radiance(x, y) || a.alpha(x, y) != b.alpha(x, y))
                return false;
    return true;
}

bool has(const render::Needs& needs, Need need) { return needs.*memberOf(need); }

Measured NeedCost::cost() const {
    return {ratio.value * variance.value,
            std::hypot(ratio.se * variance.value, variance.se * ratio.value)};
}

render::Scene forceNeed(render::Scene scene, Need need) {
    scene.forcedNeeds.*memberOf(need) = true;
    if (need == Need::Surfaces && !scene.surfaces)
        scene.surfaces = std::make_shared<surface::SurfaceSet>(
            surface::SurfaceSet{surface::Geometry({}, {}), {}, {}, {}});
    return scene;
}

std::vector<NeedCost> needsCost(const render::Scene& scene, render::RenderSettings settings,
                                const NeedsCostOptions& options) {
    const double start = wallSeconds();
    const render::Needs needs = render::findNeeds(scene);
    const auto missing = static_cast<int>(
        std::count_if(members.begin(), members.end(), [&](auto m) { return !(needs.*m); }));
    const double runs = std::max(1, missing) * 2.0 * usualPairs;
    const double wanted = options.budget / (2 * runs);
    settings = smallView(settings);
    const double oneSample = wallSecondsOf(scene, settings);
    const double least = missing * (2 * fewestPairs + 1) * oneSample;
    if (least > options.budget)
        throw usageError(
            "a budget of {} is too small: measuring {} needs of this scene takes at least {}",
            formatDuration(options.budget), missing, formatDuration(least));
    lengthen(scene, settings, std::clamp(wanted, shortestRun, longestRun));
    std::vector<NeedCost> costs;
    int left = missing;
    for (std::size_t i = 0; i < needNames.size(); ++i) {
        const Need need = static_cast<Need>(i);
        if (has(needs, need)) {
            costs.push_back({.need = need, .needed = true});
        } else {
            const double share = (start + options.budget - wallSeconds()) / left--;
            costs.push_back(measure(scene, need, settings, share, options.precision));
        }
        if (options.onResult) options.onResult(costs.back());
    }
    return costs;
}

}  // namespace woodcock::trade
