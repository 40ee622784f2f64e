// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/session.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "woodcock/base/error.h"
#include "woodcock/render/path_tracer.h"
#include "woodcock/render/sample_plan.h"
#include "woodcock/render/stages/inner_loops.h"
#include "woodcock/render/tile_order.h"
#include "woodcock/render/work_estimate.h"

namespace woodcock::render {

namespace {

constexpr int tileSize = 16;
constexpr int longestPass =
    32;  // samples per pixel: bounds a tile's buffer and the wait for a stop
constexpr std::chrono::milliseconds progressInterval{100};
/// The first sample of all pixels may take so many time limits, so that the picture is whole.
constexpr double firstPassPatience = 2;

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void validate(const RenderSettings& s, const image::Film::Window& crop) {
    if (s.width < 1 || s.height < 1)
        throw usageError("the image is {} x {}; both must be at least 1", s.width, s.height);
    if (crop.x0 < 0 || crop.y0 < 0 || crop.x1 > s.width || crop.y1 > s.height || crop.width() < 1 ||
        crop.height() < 1)
        throw usageError("the crop {},{},{},{} is empty or reaches beyond the {} x {} image",
                         crop.x0, crop.y0, crop.x1, crop.y1, s.width, s.height);
    if (s.firstSample < 0 || s.endSample <= s.firstSample)
        throw usageError("the sample range {}:{} is empty", s.firstSample, s.endSample);
    if (s.adaptive && s.firstSample > 0)
        throw usageError(
            "adaptive sampling cannot render samples {}:{} only: the first samples decide how many "
            "each pixel gets; begin at 0",
            s.firstSample, s.endSample);
}

void prepare(const Scene& scene, const Approximations& approximations) {
    if (approximations.marchStep == 0) return;
    medium::prepareMarch(scene.medium, marchSettings(approximations));
    for (const medium::Medium& medium : scene.interiorMedia)
        medium::prepareMarch(medium, marchSettings(approximations));
    for (const ApproximateMedia::Set& set : ApproximateMedia(scene, approximations).sets)
        for (const medium::Medium& medium : set)
            medium::prepareMarch(medium, marchSettings(approximations));
}

/// Samples [first, end) of each pixel, or as much work.
struct Pass {
    int first, end;
    /// The same by pixel, row by row; empty: alike in all.
    std::vector<std::uint32_t> firstOf = {}, endOf = {};
};

/// Renders passes over all tiles into a film. Each tile owns its pixels, and a pixel's samples are
/// added in their order. So the sums depend neither on threads nor on the length of passes.
class Session {
public:
    Session(const Scene& scene, const RenderSettings& settings, image::Film::Window crop)
        : scene_(scene),
          settings_(settings),
          crop_(crop),
          needs_(findNeeds(scene)),
          approximateMedia_(scene, settings.approximations),
          tracers_([this] { return PathTracer::make(scene_, needs_, tracerOptions()); }),
          film_(settings.width, settings.height, crop,
                {needs_.surfaces, settings.featureLayers, scene.lights.showsBackground()}),
          tiles_(scatteredTiles(crop, tileSize)),
          work_(tiles_.size(), settings.endSample - settings.firstSample) {}

    RenderResult run(const std::function<bool(const RenderProgress&)>& onProgress) {
        {
            const Monitor monitor(*this, onProgress);
            runPasses();
        }
        RenderResult result{std::move(film_),     needs_,   reason_, completeSamples_,
                            secondsSince(start_), counters_};
        return result;
    }

private:
    /// Calls back from a thread of its own until it is destroyed.
    class Monitor {
    public:
        Monitor(Session& session, const std::function<bool(const RenderProgress&)>& callback)
            : session_(session), callback_(callback) {
            if (callback_) thread_ = std::thread([this] { watch(); });
        }
        ~Monitor() {
            if (!callback_) return;
            {
                const std::lock_guard lock(mutex_);
                done_ = true;
            }
            wake_.notify_one();
            thread_.join();
        }
        Monitor(const Monitor&) = delete;
        Monitor& operator=(const Monitor&) = delete;

    private:
        void watch() {
            std::unique_lock lock(mutex_);
            while (!wake_.wait_for(lock, progressInterval, [this] { return done_; }))
                if (!callback_(session_.progress())) session_.stop_ = true;
            callback_(session_.progress());
        }
        Session& session_;
        const std::function<bool(const RenderProgress&)>& callback_;
        std::mutex mutex_;
        std::condition_variable wake_;
        bool done_ = false;
        std::thread thread_;
    };

    RenderProgress progress() {
        RenderProgress p;
        p.seconds = secondsSince(start_);
        const std::lock_guard lock(countersMutex_);
        const double done = work_.samplesDone();
        p.fraction = work_.fraction();
        p.samples = completeSamples_.load() - settings_.firstSample;
        p.noise = noise_.load();
        if (settings_.timeLimit > 0)
            p.fraction = std::max(p.fraction, std::min(1.0, p.seconds / settings_.timeLimit));
        if (settings_.noise > 0 && std::isfinite(p.noise)) {
            // The error falls with the square root of the samples.
            const double ratio = p.noise / settings_.noise;
            const double needed =
                std::max<double>(fewestSamplesForNoise, p.samples * ratio * ratio);
            p.fraction = std::max(p.fraction, std::min(1.0, done / needed));
        }
        // The fraction never falls, even where a new estimate of the noise is higher.
        p.fraction = fractionTold_ = std::max(fractionTold_, p.fraction);
        if (p.fraction > 0) p.secondsLeft = p.seconds * (1 - p.fraction) / p.fraction;
        return p;
    }

    void runPasses() {
        const int threads = settings_.threads > 0 ? settings_.threads : tbb::task_arena::automatic;
        std::optional<tbb::global_control> allow;  // more threads than cores, where asked for
        if (settings_.threads > 0)
            allow.emplace(tbb::global_control::max_allowed_parallelism,
                          static_cast<std::size_t>(settings_.threads));
        tbb::task_arena arena(threads);
        completeSamples_ = settings_.firstSample;
        int length = 1;
        while (completeSamples_ < settings_.endSample) {
            const Pass pass = nextPass(length);
            const int end = pass.end;
            const auto passStart = Clock::now();
            if (!arena.execute([&] { return runPass(pass); })) {
                reason_ = stop_ ? StopReason::Interrupted : StopReason::TimeLimit;
                return;
            }
            completeSamples_ = end;
            counts_ = pass.endOf;
            lookAtNoise(secondsSince(passStart), end == settings_.endSample);
            if (settings_.noise > 0 && noise_ < settings_.noise &&
                end - settings_.firstSample >= fewestSamplesForNoise) {
                if (end < settings_.endSample) reason_ = StopReason::NoiseReached;
                return;
            }
            length = std::min(2 * length, longestPass);
            if (settings_.timeLimit > 0) {
                // From the last pass, as adaptive passes cost more than the pilot.
                const double perSample = secondsSince(passStart) / (end - pass.first);
                const double left = settings_.timeLimit - secondsSince(start_);
                length = std::min(length, static_cast<int>(left / perSample));
                if (length < 1) {
                    if (end < settings_.endSample) reason_ = StopReason::TimeLimit;
                    return;
                }
            }
        }
    }

    /// Estimates the noise after a pass that took so long. Where it is only displayed, that must
    /// cost little.
    void lookAtNoise(double passSeconds, bool last) {
        sinceLook_ += passSeconds;
        if (settings_.noise == 0 && !last && sinceLook_ < 50 * lookSeconds_) return;
        const auto start = Clock::now();
        noise_ = film_.noise();
        lookSeconds_ = secondsSince(start), sinceLook_ = 0;
    }

    /// The pass of at most `length` samples for each pixel that comes next.
    Pass nextPass(int length) {
        Pass pass{completeSamples_, std::min(completeSamples_ + length, settings_.endSample)};
        if (!settings_.adaptive) return pass;
        const int pilot = SamplePlan::pilotOf(settings_.endSample);
        if (pass.first < pilot) {
            pass.end = std::min(pass.end, pilot);
            return pass;
        }
        if (!plan_) plan_.emplace(film_, pass.first), counts_ = plan_->counts(pass.first);
        pass.firstOf = counts_, pass.endOf = plan_->counts(pass.end);
        return pass;
    }

    /// False when it was stopped before its last tile.
    bool runPass(const Pass& pass) {
        const double limit =
            settings_.timeLimit * (pass.first > settings_.firstSample ? 1 : firstPassPatience);
        const auto stopping = [&] { return stop_ || (limit > 0 && secondsSince(start_) > limit); };
        {
            const std::vector<std::size_t> paths = pathsOf(pass);
            const std::lock_guard lock(countersMutex_);
            work_.begin(pass.end - pass.first, paths);
        }
        std::atomic<std::size_t> tilesDone{0};
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, tiles_.size(), 1),
            [&](const tbb::blocked_range<std::size_t>& range) {
                for (std::size_t i = range.begin(); i < range.end() && !stopping(); ++i)
                    tilesDone += renderTile(i, pass, stopping);
            },
            tbb::simple_partitioner{});
        if (tilesDone < tiles_.size()) return false;
        const std::lock_guard lock(countersMutex_);
        work_.end();
        return true;
    }

    /// How many paths each tile traces.
    std::vector<std::size_t> pathsOf(const Pass& pass) const {
        std::vector<std::size_t> paths;
        paths.reserve(tiles_.size());
        for (const image::Film::Window& tile : tiles_) {
            const auto width = static_cast<std::size_t>(tile.width());
            if (pass.endOf.empty()) {
                paths.push_back(width * static_cast<std::size_t>(tile.height()) *
                                static_cast<std::size_t>(pass.end - pass.first));
                continue;
            }
            std::size_t count = 0;
            for (int y = tile.y0; y < tile.y1; ++y) {
                const std::size_t pixel = pixelOf(tile.x0, y);
                for (std::size_t i = pixel; i < pixel + width; ++i)
                    count += pass.endOf[i] - pass.firstOf[i];
            }
            paths.push_back(count);
        }
        return paths;
    }

    std::size_t pixelOf(int x, int y) const {
        return static_cast<std::size_t>(y - crop_.y0) * static_cast<std::size_t>(crop_.width()) +
               static_cast<std::size_t>(x - crop_.x0);
    }

    std::vector<PathJob> jobsOf(const image::Film::Window& tile, const Pass& pass) const {
        std::vector<PathJob> jobs;
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x) {
                auto first = static_cast<std::uint32_t>(pass.first);
                auto end = static_cast<std::uint32_t>(pass.end);
                if (!pass.endOf.empty()) {
                    const std::size_t pixel = pixelOf(x, y);
                    first = pass.firstOf[pixel], end = pass.endOf[pixel];
                }
                for (std::uint32_t s = first; s < end; ++s) jobs.push_back({x, y, s});
            }
        return jobs;
    }

    bool renderTile(std::size_t tile, const Pass& pass, const std::function<bool()>& stopping) {
        const auto tileStart = Clock::now();
        const std::vector<PathJob> jobs = jobsOf(tiles_[tile], pass);
        std::vector<PathResult> results(jobs.size());
        RenderCounters counters;
        if (!tracers_.local()->trace(jobs, results, stopping, counters)) return false;
        for (std::size_t i = 0; i < jobs.size(); ++i) {
            film_.add(jobs[i].x, jobs[i].y, results[i].film);
            if (settings_.depthLayers || settings_.featureLayers)
                film_.add(jobs[i].x, jobs[i].y, results[i].depth);
            if (results[i].catcher.weight > 0) film_.add(jobs[i].x, jobs[i].y, results[i].catcher);
        }
        const std::lock_guard lock(countersMutex_);
        counters_ += counters;
        work_.finish(tile, secondsSince(tileStart));
        return true;
    }

    PathTracer::Options tracerOptions() const {
        return {.width = settings_.width,
                .height = settings_.height,
                .seed = settings_.seed,
                .maxScatterings = settings_.maxScatterings,
                .maxBounces = settings_.maxBounces,
                .approximations = settings_.approximations,
                .depthLayers = settings_.depthLayers,
                .featureLayers = settings_.featureLayers,
                .approximateMedia = &approximateMedia_};
    }

    static constexpr int fewestSamplesForNoise =
        8;  // with fewer samples the estimate of the error is too noisy

    const Scene& scene_;
    const RenderSettings settings_;
    const image::Film::Window crop_;
    const Needs needs_;
    const ApproximateMedia approximateMedia_;
    /// One for each thread that renders, made when it first does.
    tbb::enumerable_thread_specific<std::unique_ptr<PathTracer>> tracers_;
    image::Film film_;
    std::optional<SamplePlan> plan_;     // adaptive, once there is the pilot
    std::vector<std::uint32_t> counts_;  // and the pixels' numbers of samples by it
    const std::vector<image::Film::Window> tiles_;
    const Clock::time_point start_ = Clock::now();
    double lookSeconds_ = 0, sinceLook_ = 0;
    StopReason reason_ = StopReason::Complete;
    std::atomic<bool> stop_{false};
    std::atomic<int> completeSamples_{0};
    std::atomic<double> noise_{std::numeric_limits<double>::infinity()};
    std::mutex countersMutex_;  // of what follows
    RenderCounters counters_;
    WorkEstimate work_;
    double fractionTold_ = 0;
};

}  // namespace

RenderResult render(const Scene& scene, const RenderSettings& settings,
                    const std::function<bool(const RenderProgress&)>& onProgress) {
    const image::Film::Window crop =
        settings.crop.value_or(image::Film::Window{0, 0, settings.width, settings.height});
    validate(settings, crop);
    prepare(scene, settings.approximations);
    return Session(scene, settings, crop).run(onProgress);
}

}  // namespace woodcock::render
