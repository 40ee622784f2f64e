// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/scaling_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "woodcock/render/preparation.h"

namespace woodcock::trade {
namespace {

constexpr int rounds = 9, fewestRounds = 3;
constexpr int side = 16, threadedSide = 64;  ///< pixels; threads share tiles of 16
constexpr int mostSamples = 1 << 16;

struct Job {
    TimedRender* render;
    render::RenderSettings settings;
    std::shared_ptr<const render::Preparation> prepared = {};
    std::vector<double> microseconds = {};

    double run() {
        const double start = render->wallClock ? wallSeconds() : processorSeconds();
        const render::RenderResult result =
            woodcock::render::renderPrepared(render->scene, settings, prepared);
        const double taken = (render->wallClock ? wallSeconds() : processorSeconds()) - start;
        const render::RenderCounters& c = result.counters;
        microseconds.push_back(1e6 * taken / static_cast<double>(c.paths));
        render->seconds += taken;
        render::RenderCounters& sum = render->counters;
        sum.paths += c.paths, sum.scatterings += c.scatterings, sum.shadowRays += c.shadowRays;
        sum.distanceSegments += c.distanceSegments, sum.shadowSegments += c.shadowSegments;
        sum.distanceCollisions += c.distanceCollisions;
        sum.shadowCollisions += c.shadowCollisions;
        return taken;
    }
    void forget() {
        microseconds.clear();
        render->seconds = 0, render->counters = {};
    }
};

/// Makes a run of the job take about `seconds` of wall clock; false where not even one sample a
/// pixel does so thrice in the time of all rounds.
bool plan(Job& job, double seconds) {
    const auto taken = [&] {
        const double start = wallSeconds();
        job.run();
        return wallSeconds() - start;
    };
    job.settings.endSample = 1;
    double last = taken();  // fills the caches too
    if (last * fewestRounds > rounds * seconds) return false;
    while (last < seconds / 4 && job.settings.endSample < mostSamples) {
        const double factor = std::clamp(seconds / std::max(last, 1e-6), 2.0, 16.0);
        job.settings.endSample =
            static_cast<int>(std::min<double>(mostSamples, job.settings.endSample * factor));
        last = taken();
    }
    return true;
}

}  // namespace

void timeRenders(std::vector<TimedRender>& renders, double seconds,
                 std::vector<std::string>& notes) {
    const double end = wallSeconds() + seconds;
    // What planning itself takes is about two rounds.
    const double oneRun = seconds / static_cast<double>(renders.size()) / (rounds + 2);
    std::vector<Job> jobs;
    std::string leftOut;
    for (TimedRender& render : renders) {
        Job job{&render, {}};
        job.settings.width = job.settings.height = render.wallClock ? threadedSide : side;
        job.settings.threads = render.threads;
        job.prepared = std::make_shared<const render::Preparation>(
            render.scene, job.settings.width, job.settings.height, job.settings.approximations);
        const double fillEnd = wallSeconds() + 2 * oneRun;
        job.prepared->fill(render.threads, [=] { return wallSeconds() < fillEnd; });
        const bool planned = plan(job, oneRun);
        if (!planned)
            leftOut += fmt::format("{}{} ({:.2g} s a run)", leftOut.empty() ? "" : ", ",
                                   render.name, render.seconds);
        job.forget();
        if (planned) jobs.push_back(std::move(job));
    }
    if (!leftOut.empty()) notes.push_back("the budget was too small for " + leftOut);
    for (int round = 0; round < rounds; ++round) {
        if (round >= fewestRounds && wallSeconds() > end) break;
        for (Job& job : jobs) {
            job.settings.seed = static_cast<std::uint64_t>(round) + 1;
            job.run();
        }
    }
    for (Job& job : jobs) job.render->microseconds = medianOf(job.microseconds);
}

}  // namespace woodcock::trade
