// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/session.h"

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

namespace woodcock {

namespace {

constexpr int tileSize = 16;
constexpr int longestPass =
    32;  // samples per pixel: bounds a tile's buffer and the wait for a stop
constexpr std::chrono::milliseconds progressInterval{100};

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void validate(const RenderSettings& s, const Film::Window& crop) {
    if (s.width < 1 || s.height < 1)
        throw usageError("the image is {} x {}; both must be at least 1", s.width, s.height);
    if (crop.x0 < 0 || crop.y0 < 0 || crop.x1 > s.width || crop.y1 > s.height || crop.width() < 1 ||
        crop.height() < 1)
        throw usageError("the crop {},{},{},{} is empty or leaves the {} x {} image", crop.x0,
                         crop.y0, crop.x1, crop.y1, s.width, s.height);
    if (s.firstSample < 0 || s.endSample <= s.firstSample)
        throw usageError("the sample range {}:{} is empty", s.firstSample, s.endSample);
    if (s.adaptive && s.firstSample > 0)
        throw usageError(
            "adaptive sampling cannot render samples {}:{} alone: how many samples a pixel gets "
            "follows from its first ones",
            s.firstSample, s.endSample);
}

void add(RenderCounters& a, const RenderCounters& b) {
    a.paths += b.paths, a.scatterings += b.scatterings, a.shadowRays += b.shadowRays;
    a.distanceSegments += b.distanceSegments, a.distanceCollisions += b.distanceCollisions;
    a.shadowSegments += b.shadowSegments, a.shadowCollisions += b.shadowCollisions;
    a.surfaceRays += b.surfaceRays, a.clamped += b.clamped;
}

void prepare(const Scene& scene, const Approximations& approximations) {
    if (approximations.marchStep == 0) return;
    prepareMarch(scene.medium, marchSettings(approximations));
    for (const Medium& medium : scene.interiors)
        prepareMarch(medium, marchSettings(approximations));
    for (const StandIns::Set& set : StandIns(scene, approximations).sets)
        for (const Medium& medium : set) prepareMarch(medium, marchSettings(approximations));
}

/// Samples [first, end) of each pixel in the mean.
struct Pass {
    int first, end;
    /// The same by pixel, row by row; empty: alike in all.
    std::vector<std::uint32_t> firstOf = {}, endOf = {};
};

/// Renders passes over all tiles into a film. Tiles own their pixels, and a pixel's samples are
/// added in their order, so neither threads nor the length of passes shows in the sums.
class Session {
public:
    Session(const Scene& scene, const RenderSettings& settings, Film::Window crop)
        : scene_(scene),
          settings_(settings),
          crop_(crop),
          needs_(findNeeds(scene)),
          standIns_(scene, settings.approximations),
          film_(settings.width, settings.height, crop, {needs_.surfaces, settings.featureLayers}) {
        for (int y = crop.y0 / tileSize * tileSize; y < crop.y1; y += tileSize)
            for (int x = crop.x0 / tileSize * tileSize; x < crop.x1; x += tileSize)
                tiles_.push_back({std::max(x, crop.x0), std::max(y, crop.y0),
                                  std::min(x + tileSize, crop.x1),
                                  std::min(y + tileSize, crop.y1)});
        pathsPerSample_ =
            static_cast<std::uint64_t>(crop.width()) * static_cast<std::uint64_t>(crop.height());
    }

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

    RenderProgress progress() const {
        RenderProgress p;
        p.seconds = secondsSince(start_);
        const auto total =
            static_cast<double>(pathsPerSample_) * (settings_.endSample - settings_.firstSample);
        p.fraction = std::min(1.0, static_cast<double>(pathsDone_.load()) / total);
        p.samples = completeSamples_.load() - settings_.firstSample;
        p.noise = noise_.load();
        if (settings_.timeLimit > 0)
            p.fraction = std::max(p.fraction, std::min(1.0, p.seconds / settings_.timeLimit));
        if (settings_.noise > 0 && p.noise > 0 &&
            std::isfinite(p.noise)) {  // the error falls with the root of the time
            const double ratio = settings_.noise / p.noise;
            p.fraction = std::max(p.fraction, std::min(1.0, ratio * ratio));
        }
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
            noise_ = film_.noise();
            if (settings_.noise > 0 && noise_ > 0 && noise_ < settings_.noise &&
                end - settings_.firstSample >= fewestSamplesForNoise) {
                if (end < settings_.endSample) reason_ = StopReason::NoiseReached;
                return;
            }
            length = std::min(2 * length, longestPass);
            if (settings_.timeLimit > 0) {
                // Of the last pass, as adaptive ones cost more than the pilot.
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
        const auto stopping = [&] {
            return stop_ || (pass.first > settings_.firstSample && settings_.timeLimit > 0 &&
                             secondsSince(start_) > settings_.timeLimit);
        };
        std::atomic<std::size_t> tilesDone{0};
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, tiles_.size(), 1),
            [&](const tbb::blocked_range<std::size_t>& range) {
                for (std::size_t i = range.begin(); i < range.end() && !stopping(); ++i)
                    tilesDone += renderTile(tiles_[i], pass, stopping);
            },
            tbb::simple_partitioner{});
        return tilesDone == tiles_.size();
    }

    std::vector<PathJob> jobsOf(const Film::Window& tile, const Pass& pass) const {
        std::vector<PathJob> jobs;
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x) {
                auto first = static_cast<std::uint32_t>(pass.first);
                auto end = static_cast<std::uint32_t>(pass.end);
                if (!pass.endOf.empty()) {
                    const auto pixel = static_cast<std::size_t>(y - crop_.y0) *
                                           static_cast<std::size_t>(crop_.width()) +
                                       static_cast<std::size_t>(x - crop_.x0);
                    first = pass.firstOf[pixel], end = pass.endOf[pixel];
                }
                for (std::uint32_t s = first; s < end; ++s) jobs.push_back({x, y, s});
            }
        return jobs;
    }

    bool renderTile(const Film::Window& tile, const Pass& pass,
                    const std::function<bool()>& stopping) {
        const std::vector<PathJob> jobs = jobsOf(tile, pass);
        std::vector<PathResult> results(jobs.size());
        const auto tracer = PathTracer::make(
            scene_, needs_,
            {settings_.width, settings_.height, settings_.seed, settings_.maxScatterings,
             settings_.maxBounces, settings_.approximations, settings_.depthLayers,
             settings_.featureLayers, &standIns_});
        if (!tracer->trace(jobs, results, stopping)) return false;
        for (std::size_t i = 0; i < jobs.size(); ++i) {
            film_.add(jobs[i].x, jobs[i].y, results[i].film);
            if (settings_.depthLayers || settings_.featureLayers)
                film_.add(jobs[i].x, jobs[i].y, results[i].depth);
            if (results[i].catcher.weight > 0) film_.add(jobs[i].x, jobs[i].y, results[i].catcher);
        }
        pathsDone_ += jobs.size();
        const std::lock_guard lock(countersMutex_);
        add(counters_, tracer->counters());
        return true;
    }

    static constexpr int fewestSamplesForNoise =
        8;  // below, the estimate of the error is itself noise

    const Scene& scene_;
    const RenderSettings settings_;
    const Film::Window crop_;
    const Needs needs_;
    const StandIns standIns_;
    Film film_;
    std::optional<SamplePlan> plan_;     // adaptive, once there is the pilot
    std::vector<std::uint32_t> counts_;  // and what the pixels have by it
    std::vector<Film::Window> tiles_;
    std::uint64_t pathsPerSample_ = 0;
    const Clock::time_point start_ = Clock::now();
    StopReason reason_ = StopReason::Complete;
    std::atomic<bool> stop_{false};
    std::atomic<std::uint64_t> pathsDone_{0};
    std::atomic<int> completeSamples_{0};
    std::atomic<double> noise_{std::numeric_limits<double>::infinity()};
    std::mutex countersMutex_;
    RenderCounters counters_;
};

}  // namespace

RenderResult render(const Scene& scene, const RenderSettings& settings,
                    const std::function<bool(const RenderProgress&)>& onProgress) {
    const Film::Window crop =
        settings.crop.value_or(Film::Window{0, 0, settings.width, settings.height});
    validate(settings, crop);
    prepare(scene, settings.approximations);
    return Session(scene, settings, crop).run(onProgress);
}

}  // namespace woodcock
