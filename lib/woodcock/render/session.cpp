// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/session.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <new>
#include <shared_mutex>
#include <utility>

#include "woodcock/base/error.h"
#include "woodcock/render/deep_bins.h"
#include "woodcock/render/empty_pixels.h"
#include "woodcock/render/path_tracer.h"
#include "woodcock/render/preparation.h"
#include "woodcock/render/repeated_call.h"
#include "woodcock/render/sample_plan.h"
#include "woodcock/render/stages/inner_loops.h"
#include "woodcock/render/tile_order.h"
#include "woodcock/render/work_estimate.h"

namespace woodcock::render {

namespace {

constexpr int tileSize = 16;
constexpr int longestPass =
    32;  // samples per pixel: bounds a tile's buffer and the wait for a stop
constexpr std::chrono::milliseconds pollInterval{100};
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
    const bool deep = s.deepError > 0;
    if (deep || !s.mattes.empty())
        if (const std::string flaw = compositingFlaw(s.approximations, deep); !flaw.empty())
            throw usageError("{}", flaw);
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

/// The given one where it fits, else a new one.
std::shared_ptr<const Preparation> fitting(std::shared_ptr<const Preparation> given,
                                           const Scene& scene, const RenderSettings& s) {
    if (given && given->fits(scene, s.width, s.height, s.approximations)) return given;
    return std::make_shared<const Preparation>(scene, s.width, s.height, s.approximations);
}

std::optional<image::MatteFilm> mattesOf(const RenderSettings& settings, image::Film::Window crop) {
    if (settings.mattes.empty()) return std::nullopt;
    return image::MatteFilm(crop, settings.mattes);
}

std::optional<image::DeepFilm> deepOf(const Scene& scene, const Needs& needs,
                                      const RenderSettings& settings, image::Film::Window crop,
                                      int copies) {
    if (!(settings.deepError > 0)) return std::nullopt;
    const DeepBins bins(scene, needs, settings.width, settings.height, settings.deepError);
    const auto width = static_cast<std::size_t>(crop.width());
    std::vector<std::vector<float>> edges(width * static_cast<std::size_t>(crop.height()));
    const auto find = [&](int y) {
        for (int x = crop.x0; x < crop.x1; ++x)
            edges[static_cast<std::size_t>(y - crop.y0) * width +
                  static_cast<std::size_t>(x - crop.x0)] = bins.edges(x, y);
    };
    const int threads = settings.threads > 0 ? settings.threads : tbb::task_arena::automatic;
    tbb::task_arena(threads).execute([&] { tbb::parallel_for(crop.y0, crop.y1, find); });
    return image::DeepFilm(crop, settings.deepError, edges, copies);
}

/// Whether a film takes the sample: what it drops is not in mattes and deep pixels either.
bool isFinite(const image::FilmSample& sample) {
    return sample.radiance.isFinite() && std::isfinite(sample.alpha);
}

/// Samples [first, end) of each pixel, or as much work, as far as they are not drawn yet.
struct Pass {
    int first, end;
    std::vector<std::uint32_t> endOf = {};  ///< by pixel, row by row; empty: alike in all
};

/// Renders passes over all tiles into a film. Each tile owns its pixels, and a pixel's samples are
/// added in their order. So the sums depend neither on threads nor on the length of passes.
class Session {
public:
    Session(const Scene& scene, const RenderSettings& settings, image::Film::Window crop,
            Checkpoints checkpoints, std::shared_ptr<const Preparation> prepared)
        : scene_(scene),
          settings_(settings),
          crop_(crop),
          needs_(findNeeds(scene)),
          prepared_(fitting(std::move(prepared), scene, settings)),
          tracers_([this] { return PathTracer::make(scene_, needs_, tracerOptions()); }),
          state_{image::Film(settings.width, settings.height, crop,
                             {.surfaces = needs_.surfaces,
                              .features = settings.layers.features,
                              .background = scene.lights.showsBackground(),
                              .places = settings.layers.places,
                              .stops = settings.layers.stops,
                              .parts = settings.layers.parts}),
                 mattesOf(settings, crop)},
          tiles_(scatteredTiles(crop, tileSize)),
          work_(tiles_.size(), settings.endSample - settings.firstSample),
          checkpoints_(std::move(checkpoints)) {
        emptyPixels_.emplace(scene, needs_, tracerOptions());
        state_.endSample = settings.firstSample;
        state_.drawn.assign(state_.film.pixelCount(),
                            static_cast<std::uint32_t>(settings.firstSample));
        if (checkpoints_.from)
            goOnFrom(*std::exchange(checkpoints_.from, {}));
        else
            state_.deep = deepOf(scene, needs_, settings, crop, checkpoints_.planned ? 2 : 1);
    }

    RenderResult run(const std::function<bool(const RenderProgress&)>& onProgress) {
        const auto tell = [&] {
            if (!onProgress(progress())) stop_ = true;
        };
        {
            const RepeatedCall telling(pollInterval, onProgress ? tell : std::function<void()>());
            const RepeatedCall saving(pollInterval, checkpoints_.wanted
                                                        ? [this] { saveWhereWanted(); }
                                                        : std::function<void()>());
            runPasses();
        }
        // Only now: whoever goes on from a checkpoint of the last moment must see the end again.
        state_.endSample = std::max(state_.endSample, endedAt_);
        state_.seconds = seconds();
        if (onProgress) onProgress(progress());
        return {std::move(state_), needs_, reason_};
    }

private:
    void goOnFrom(RenderState from) {
        const bool sameMattes =
            state_.mattes ? from.mattes && state_.mattes->isLike(*from.mattes) : !from.mattes;
        const bool sameDeep = settings_.deepError > 0
                                  ? from.deep && from.deep->crop() == crop_ &&
                                        from.deep->error() == settings_.deepError
                                  : !from.deep;
        if (!state_.film.isLike(from.film) || from.drawn.size() != state_.drawn.size() ||
            !sameMattes || !sameDeep)
            throw usageError("the checkpoint is of a picture of another size or with other layers");
        const std::uint32_t most = *std::max_element(from.drawn.begin(), from.drawn.end());
        if (from.endSample < settings_.firstSample || from.endSample > settings_.endSample ||
            (!settings_.adaptive && most > static_cast<std::uint32_t>(settings_.endSample)))
            throw usageError(
                "the checkpoint holds samples up to {} of a pixel, and only {}:{} are asked for",
                most, settings_.firstSample, settings_.endSample);
        secondsBefore_ = from.seconds;
        work_.resumeAfter(from.endSample - settings_.firstSample);
        if (state_.mattes) {
            state_.mattes->takeSums(std::move(*from.mattes));
            from.mattes = std::move(state_.mattes);
        }
        state_ = std::move(from);
    }

    double seconds() const { return secondsBefore_ + secondsSince(start_); }

    void saveWhereWanted() {
        if (!checkpoints_.wanted()) return;
        try {
            checkpoints_.write(snapshot());
        } catch (const std::bad_alloc&) {
            // The next one may find the memory.
        }
    }

    RenderState snapshot() {
        const std::unique_lock lock(stateMutex_);
        RenderState copy = state_;
        copy.seconds = seconds();
        return copy;
    }

    RenderProgress progress() {
        RenderProgress p;
        p.seconds = seconds();
        const std::shared_lock stateLock(stateMutex_);
        const std::lock_guard lock(countersMutex_);
        const double done = work_.samplesDone();
        p.fraction = work_.fraction();
        p.samples = state_.endSample - settings_.firstSample;
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
        while (state_.endSample < settings_.endSample) {
            const Pass pass = nextPass();
            const int end = pass.end;
            const auto passStart = Clock::now();
            if (!arena.execute([&] { return runPass(pass); })) {
                reason_ = stop_ ? StopReason::Interrupted : StopReason::TimeLimit;
                return;
            }
            lookAtNoise(secondsSince(passStart), end == settings_.endSample);
            const bool quiet = settings_.noise > 0 && noise_ < settings_.noise &&
                               end - settings_.firstSample >= fewestSamplesForNoise;
            int length = std::min(2 * state_.passLength, longestPass);
            bool inTime = true;
            if (settings_.timeLimit > 0) {
                // From the last pass, as adaptive passes cost more than the pilot.
                const double perSample = secondsSince(passStart) / (end - pass.first);
                length = std::min(length,
                                  static_cast<int>((settings_.timeLimit - seconds()) / perSample));
                inTime = length >= 1;
            }
            if (end == settings_.endSample || quiet || !inTime) {
                if (end < settings_.endSample)
                    reason_ = quiet ? StopReason::NoiseReached : StopReason::TimeLimit;
                endedAt_ = end;
                return;
            }
            const std::unique_lock lock(stateMutex_);
            state_.endSample = end, state_.passLength = length;
        }
    }

    /// Estimates the noise after a pass that took so long. Where it is only displayed, that must
    /// cost little.
    void lookAtNoise(double passSeconds, bool last) {
        sinceLook_ += passSeconds;
        if (settings_.noise == 0 && !last && sinceLook_ < 50 * lookSeconds_) return;
        const auto start = Clock::now();
        noise_ = state_.film.noise();
        lookSeconds_ = secondsSince(start), sinceLook_ = 0;
    }

    /// The pass that comes next.
    Pass nextPass() {
        Pass pass{state_.endSample,
                  std::min(state_.endSample + state_.passLength, settings_.endSample)};
        if (!settings_.adaptive) return pass;
        const int pilot = SamplePlan::pilotOf(settings_.endSample);
        if (pass.first < pilot) {
            pass.end = std::min(pass.end, pilot);
            return pass;
        }
        if (!state_.plan) {
            SamplePlan plan(state_.film, pass.first);
            const std::unique_lock lock(stateMutex_);
            state_.plan = std::move(plan);
        }
        pass.endOf = state_.plan->counts(pass.end);
        return pass;
    }

    /// False when it was stopped before its last tile.
    bool runPass(const Pass& pass) {
        const double limit =
            settings_.timeLimit * (pass.first > settings_.firstSample ? 1 : firstPassPatience);
        const auto stopping = [&] { return stop_ || (limit > 0 && seconds() > limit); };
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
            std::size_t count = 0;
            eachPixel(tile, pass, [&](int, int, std::uint32_t first, std::uint32_t end) {
                count += end - first;
            });
            paths.push_back(count);
        }
        return paths;
    }

    /// Calls act(x, y, first, end) for the samples [first, end) that the pass draws in each pixel.
    template <class Act>
    void eachPixel(const image::Film::Window& tile, const Pass& pass, Act act) const {
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x) {
                const std::size_t pixel = pixelOf(x, y);
                const std::uint32_t first = state_.drawn[pixel];
                const std::uint32_t end =
                    pass.endOf.empty() ? static_cast<std::uint32_t>(pass.end) : pass.endOf[pixel];
                act(x, y, first, std::max(first, end));
            }
    }

    std::size_t pixelOf(int x, int y) const {
        return static_cast<std::size_t>(y - crop_.y0) * static_cast<std::size_t>(crop_.width()) +
               static_cast<std::size_t>(x - crop_.x0);
    }

    bool renderTile(std::size_t tile, const Pass& pass, const std::function<bool()>& stopping) {
        const auto tileStart = Clock::now();
        std::vector<PathJob> jobs;
        eachPixel(tiles_[tile], pass, [&](int x, int y, std::uint32_t first, std::uint32_t end) {
            for (std::uint32_t s = first; s < end; ++s) jobs.push_back({x, y, s});
        });
        std::vector<PathResult> results(jobs.size());
        const image::LayerNeeds& layers = settings_.layers;
        const std::size_t ofPath = layers.parts.count();
        std::vector<Rgb> parts(jobs.size() * ofPath);
        std::vector<image::PlaceSample> places(layers.places ? jobs.size() : 0);
        std::vector<image::StopSample> stops(layers.stops ? jobs.size() : 0);
        RenderCounters counters;
        if (!tracers_.local()->trace(jobs, results, {parts, places, stops}, stopping, counters))
            return false;
        const std::shared_lock stateLock(stateMutex_);
        image::Film& film = state_.film;
        for (std::size_t i = 0; i < jobs.size(); ++i) {
            const auto [x, y, sample] = jobs[i];
            film.add(x, y, results[i].film, std::span(parts).subspan(i * ofPath, ofPath));
            if (layers.places)
                film.add(x, y, results[i].depth, places[i]);
            else if (layers.depthSamples())
                film.add(x, y, results[i].depth);
            if (layers.stops) film.add(x, y, stops[i]);
            if (results[i].catcher.weight > 0) film.add(x, y, results[i].catcher);
            if (results[i].stopped && isFinite(results[i].film)) addStopped(jobs[i], results[i]);
            state_.drawn[pixelOf(x, y)] = sample + 1;
        }
        const std::lock_guard lock(countersMutex_);
        state_.counters += counters;
        work_.finish(tile, secondsSince(tileStart));
        return true;
    }

    void addStopped(const PathJob& job, const PathResult& result) {
        if (state_.mattes) state_.mattes->add(job.x, job.y, *result.stopped);
        if (state_.deep) state_.deep->add(job.x, job.y, *result.stopped);
    }

    PathTracer::Options tracerOptions() const {
        return {.width = settings_.width,
                .height = settings_.height,
                .seed = settings_.seed,
                .maxScatterings = settings_.maxScatterings,
                .maxBounces = settings_.maxBounces,
                .approximations = settings_.approximations,
                .layers = settings_.layers,
                .stoppedLight = state_.mattes || state_.deep,
                .approximateMedia = &prepared_->approximateMedia(),
                .lightDepths = &prepared_->lightDepths(),
                .cameraDepths = prepared_->cameraDepths(),
                .radiance = prepared_->radianceLattice(),
                .emptyPixels = emptyPixels_ ? &*emptyPixels_ : nullptr};
    }

    static constexpr int fewestSamplesForNoise =
        8;  // with fewer samples the estimate of the error is too noisy

    const Clock::time_point start_ = Clock::now();
    const Scene& scene_;
    const RenderSettings settings_;
    const image::Film::Window crop_;
    const Needs needs_;
    const std::shared_ptr<const Preparation> prepared_;
    std::optional<EmptyPixels> emptyPixels_;  // made from the other options
    /// One for each thread that renders, made when it first does.
    tbb::enumerable_thread_specific<std::unique_ptr<PathTracer>> tracers_;
    /// Whoever adds finished tiles shares it, as tiles have their own pixels; whoever copies it or
    /// changes the rest has it alone.
    std::shared_mutex stateMutex_;
    RenderState state_;
    const std::vector<image::Film::Window> tiles_;
    double secondsBefore_ = 0;  // an interruption
    double lookSeconds_ = 0, sinceLook_ = 0;
    StopReason reason_ = StopReason::Complete;
    int endedAt_ = 0;  // 0: inside of a pass
    std::atomic<bool> stop_{false};
    std::atomic<double> noise_{std::numeric_limits<double>::infinity()};
    std::mutex countersMutex_;  // of state_.counters and what follows
    WorkEstimate work_;
    double fractionTold_ = 0;
    Checkpoints checkpoints_;
};

}  // namespace

std::string compositingFlaw(const Approximations& approximations, bool deep) {
    const char* const what = deep ? "deep pixels" : "mattes";
    if (approximations.marchStep > 0)
        return fmt::format(
            "{} need tracked rays, and march_step marches them: what stops a ray where is not "
            "known of marched ones. Set march_step = 0",
            what);
    if (!deep) return "";
    if (approximations.similarityAfter == 0)
        return "deep pixels need the true media on camera rays, and similarity_after = 0 replaces "
               "them. Set similarity_after = 1 or more";
    if (approximations.clamp > 0)
        return "deep pixels need each path's whole radiance, and clamp cuts it. Set clamp = 0";
    return "";
}

RenderResult render(const Scene& scene, const RenderSettings& settings,
                    const std::function<bool(const RenderProgress&)>& onProgress,
                    Checkpoints checkpoints) {
    return renderPrepared(scene, settings, {}, onProgress, std::move(checkpoints));
}

RenderResult renderPrepared(const Scene& scene, const RenderSettings& settings,
                            std::shared_ptr<const Preparation> prepared,
                            const std::function<bool(const RenderProgress&)>& onProgress,
                            Checkpoints checkpoints) {
    const image::Film::Window crop =
        settings.crop.value_or(image::Film::Window{0, 0, settings.width, settings.height});
    validate(settings, crop);
    prepare(scene, settings.approximations);
    return Session(scene, settings, crop, std::move(checkpoints), std::move(prepared))
        .run(onProgress);
}

}  // namespace woodcock::render
