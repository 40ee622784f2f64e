// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/trade.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "woodcock/base/error.h"
#include "woodcock/base/memory.h"
#include "woodcock/base/parse.h"
#include "woodcock/scene/denoising.h"
#include "woodcock/scene/quality.h"
#include "woodcock/trade/evaluate.h"

namespace woodcock::trade {
namespace {

constexpr double mostPixels = 40000;  // more samples are worth more than more pixels
constexpr double fewestPixels = 256;
constexpr int leastSamples = 4;
constexpr int pilotSeeds = 2, pilotSamples = 2;
constexpr int stagesOfSeed = 3;  ///< at most; see stageCounts()
// Shares of the budget.
constexpr double fillingShare = 0.15, loadingShare = 0.25, renderingShare = 0.88, cropShare = 0.05,
                 hardShare = 1.05;
constexpr double unbiasedWeight = 0.25;  // whose squared bias decides nothing

/// Each use has seeds of its own, so that results are independent.
enum class Use : std::uint64_t { Candidate = 1, Reference, Pilot, Probe };
std::uint64_t seedOf(std::uint64_t seed, Use use, int index) {
    return seed + (static_cast<std::uint64_t>(use) << 20) + static_cast<std::uint64_t>(index);
}

/// Thrown where the callback returned false, and caught by runTrade().
struct Interrupted {};
/// Thrown where the time is up in the middle of a picture.
struct TimeIsUp {};

double meanOfPixels(const Pixels& pixels) {
    double sum = 0;
    for (const float v : pixels) sum += double{v};
    return sum / static_cast<double>(pixels.size());
}

/// Half the mean square of the difference of two pictures, relative to their mean squared: rough,
/// but enough to share time by.
double pilotVariance(const Pixels& a, const Pixels& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(double{a[i]} - double{b[i]}, 2);
    const double mean = (meanOfPixels(a) + meanOfPixels(b)) / 2;
    return mean > 0 ? sum / static_cast<double>(a.size()) / 2 / (mean * mean) : 0;
}

class TradeRun {
public:
    TradeRun(const scene::SceneDescription& complete, const ParseScene& parse,
             const TradeSettings& settings)
        : complete_(complete),
          parse_(parse),
          settings_(settings),
          full_{complete.render.width, complete.render.height} {
        reference_ = withChoices(complete, parse({"render.quality=reference"}));
    }

    TradeResult run(const std::vector<Candidate>& given) {
        tell("the reference is loaded");
        referenceLoad_ = store_.get(reference_).loadSeconds;
        probe();
        chooseCandidates(given);
        chooseSize();
        const std::vector<PilotCost> costs = pilot();
        render(plan(costs));
        TradeResult result = evaluateTrade(measurements_, flipShare());
        result.notes.insert(result.notes.begin(), notes_.begin(), notes_.end());
        if (settings_.crops) renderCrops(result);
        result.seconds = watch_.seconds();
        return result;
    }

private:
    double left(double share) const { return share * settings_.budget - watch_.seconds(); }

    void tell(const std::string& what) {
        what_ = what;
        if (settings_.onProgress &&
            !settings_.onProgress(std::min(1.0, watch_.seconds() / settings_.budget), what))
            throw Interrupted();
    }

    Error tooSmall(double needed) const {
        return usageError(
            "a budget of {} is too small for {} candidates on this scene; give about {}, or fewer "
            "candidates",
            formatDuration(settings_.budget), resolved_.size(),
            formatDuration(std::ceil(1.3 * needed)));
    }

    std::vector<Stage> render(const Subject& subject, Use use, int index,
                              const std::vector<int>& counts) {
        bool stopped = false;
        const auto goOn = [&] {
            stopped =
                settings_.onProgress &&
                !settings_.onProgress(std::min(1.0, watch_.seconds() / settings_.budget), what_);
            return !stopped && (left(hardShare) > 0 || use == Use::Probe);
        };
        auto stages = renderStages(subject, seedOf(settings_.seed, use, index), counts,
                                   settings_.threads, goOn);
        if (stopped) throw Interrupted();
        if (!stages) throw TimeIsUp();
        return std::move(*stages);
    }

    /// How fast and how bright the scene is, from a very small picture.
    void probe() {
        const PictureSize size = sizeOfPixels(full_, 2 * fewestPixels);
        const Subject subject(store_.get(reference_), reference_, size);
        const Stage stage = render(subject, Use::Probe, 0, {1, 5}).back();
        meanRadiance_ = meanOfPixels(stage.pixels);
        secondsPerPixel_ = stage.seconds / stage.samples / size.pixels();
    }

    void chooseCandidates(const std::vector<Candidate>& given) {
        std::vector<Candidate> candidates = given;
        if (given.empty()) {
            SceneFacts facts = sceneFacts(reference_, store_.get(reference_).scene);
            facts.meanRadiance = meanRadiance_;
            facts.denoiser = settings_.denoises && isDenoiserInstalled();
            candidates = builtInCandidates(facts, settings_.extent);
        }
        resolved_ = resolveCandidates(candidates, complete_, parse_, !given.empty());
        for (ResolvedCandidate& r : resolved_) settleDenoising(r);
        if (denoiser_) {
            const image::Film::Window least{0, 0, 16, 16};
            const image::Film black(least.x1, least.y1, least,
                                    {.surfaces = false, .features = true});
            measurements_.denoiserStart = denoiser_->denoise(black, settings_.threads).seconds;
        }
        const double most = loadingShare * settings_.budget;
        const auto memory = static_cast<double>(memoryLimit()) / 2;
        std::vector<std::string> slow;
        double bytes = static_cast<double>(store_.get(reference_).bytes);
        std::erase_if(resolved_, [&](const ResolvedCandidate& r) {
            if (store_.has(r.scene)) return false;
            bytes += static_cast<double>(store_.get(reference_).bytes);
            if (watch_.seconds() + referenceLoad_ < most && bytes < memory) {
                tell(r.candidate.name + " is loaded");
                store_.get(r.scene);
                return false;
            }
            slow.push_back(r.candidate.name);
            return true;
        });
        if (!slow.empty())
            notes_.push_back(
                fmt::format("there was not enough time or memory to load the scene again for: {}",
                            joined(slow)));
        if (resolved_.empty()) throw tooSmall(watch_.seconds() / loadingShare);
    }

    static bool isDenoiserInstalled() {
        try {
            return denoise::Denoiser::find().has_value();
        } catch (const Error&) {
            return false;  // it does not work
        }
    }

    void settleDenoising(ResolvedCandidate& r) {
        if (!settings_.denoises) r.scene.render.denoise = scene::Denoise::Never;
        try {
            if (const auto denoiser = scene::settleDenoising(r.scene)) denoiser_ = denoiser;
        } catch (const Error& e) {
            throw Error(e.kind(), fmt::format("candidate '{}': {}", r.candidate.name, e.what()));
        }
    }

    /// The pictures of a settled scene.
    std::optional<denoise::Denoiser> denoiserOf(const scene::SceneDescription& scene) const {
        return scene.render.denoise == scene::Denoise::Always ? denoiser_ : std::nullopt;
    }

    static std::string joined(const std::vector<std::string>& names) {
        return fmt::format("{}", fmt::join(names, ", "));
    }

    void chooseSize() {
        const double perPixel = secondsPerPixel_ * (settings_.crops ? 1.1 : 1.0);
        const double least = leastSamplesPerPixel(resolved_.size()) * perPixel;
        const double smallest = std::min(fewestPixels, full_.pixels());
        if (left(renderingShare) < least * smallest)
            throw tooSmall((watch_.seconds() + least * smallest) / renderingShare);
        const double pixels =
            left(renderingShare) / (goodSamplesPerPixel(resolved_.size()) * perPixel);
        size_ = sizeOfPixels(full_, std::clamp(pixels, smallest, mostPixels));
        for (const ResolvedCandidate& r : resolved_)
            subjects_.emplace_back(store_.get(r.scene), r.scene, size_, denoiserOf(r.scene));
        referenceSubject_ = Subject(store_.get(reference_), reference_, size_);
        tell("grids of optical depths are made");
        const auto goOn = [&] { return left(fillingShare) > 0; };
        for (const Subject& subject : subjects_) subject.prepared->fill(settings_.threads, goOn);
        if (size_.pixels() < full_.pixels())
            notes_.push_back(
                fmt::format("measured at {} x {} pixels; seconds are scaled to {} x {}",
                            size_.width, size_.height, full_.width, full_.height));
    }

    PilotCost pilotOf(const Subject& subject, const std::string& name) {
        tell("pilot of " + name);
        std::vector<Stage> stages;
        for (int k = 0; k < pilotSeeds; ++k)
            stages.push_back(render(subject, Use::Pilot, k, {pilotSamples}).back());
        const double samples = stages[0].samples;
        denoiseSeconds_ += tradeSeeds * stagesOfSeed * stages.back().denoiseSeconds;
        return {(stages[0].seconds + stages[1].seconds) / 2 / samples,
                pilotVariance(stages[0].pixels, stages[1].pixels) * samples, 1};
    }

    std::vector<PilotCost> pilot() {
        try {
            std::vector<PilotCost> costs;
            for (std::size_t i = 0; i < subjects_.size(); ++i) {
                costs.push_back(pilotOf(subjects_[i], resolved_[i].candidate.name));
                if (!isBiased(resolved_[i].scene)) costs.back().weight = unbiasedWeight;
            }
            referenceCost_ = pilotOf(referenceSubject_, "the reference");
            return costs;
        } catch (const TimeIsUp&) {
            throw tooSmall(2 * settings_.budget);
        }
    }

    TradePlan plan(const std::vector<PilotCost>& costs) {
        double available = left(renderingShare) - denoiseSeconds_;
        if (settings_.crops) available -= cropShare * settings_.budget;
        const TradePlan made = planTrade(costs, referenceCost_, available, leastSamples);
        if (made.seconds > 1.2 * available)
            throw tooSmall((watch_.seconds() + made.seconds) / renderingShare);
        return made;
    }

    bool isBiased(const scene::SceneDescription& scene) const {
        std::vector<std::string> own = scene::biasedChoices(scene),
                                 all = scene::biasedChoices(reference_);
        std::erase_if(own, [&](const std::string& key) {
            return std::find(all.begin(), all.end(), key) != all.end();
        });
        return !own.empty() || scene.render.maxScatterings != reference_.render.maxScatterings ||
               scene.render.maxBounces != reference_.render.maxBounces;
    }

    /// Rounds of a seed each, in which every candidate has a turn: if the machine is slow for a
    /// while, all are affected. An incomplete last round is left out.
    void render(const TradePlan& plan) {
        TradeMeasurements& m = measurements_;
        m.full = full_, m.measured = size_;
        for (std::size_t i = 0; i < resolved_.size(); ++i) {
            const BuiltScene& built = store_.get(resolved_[i].scene);
            m.candidates.push_back({resolved_[i].candidate,
                                    isBiased(resolved_[i].scene),
                                    built.loadSeconds,
                                    built.bytes,
                                    {},
                                    subjects_[i].denoiser.has_value()});
        }
        double longestRound = 0;
        for (int k = 0; k < mostTradeSeeds; ++k) {
            const double needed = (k < tradeSeeds ? 0.8 : 1.05) * longestRound;
            if (k >= pilotSeeds && left(renderingShare) < needed) break;
            const Stopwatch round;
            try {
                renderRound(plan, k);
            } catch (const TimeIsUp&) {
                if (k < pilotSeeds) throw tooSmall(2 * settings_.budget);
                m.dropRound(k);
                break;
            }
            longestRound = std::max(longestRound, round.seconds());
        }
        if (m.candidates.front().seeds.size() < tradeSeeds)
            notes_.push_back(fmt::format(
                "time ran out after {} of {} seeds: the machine was slower than in the pilot run",
                m.candidates.front().seeds.size(), tradeSeeds));
    }

    void renderRound(const TradePlan& plan, int k) {
        TradeMeasurements& m = measurements_;
        for (std::size_t i = 0; i < subjects_.size(); ++i) {
            tell(fmt::format("round {} of {}: {}", k + 1, tradeSeeds,
                             m.candidates[i].candidate.name));
            m.candidates[i].seeds.push_back(
                render(subjects_[i], Use::Candidate, k, stageCounts(plan.candidates[i])));
        }
        tell("seeds of the reference");
        constexpr int perRound = tradeReferenceSeeds / tradeSeeds;
        for (int j = 0; j < perRound; ++j)
            m.reference.push_back(
                render(referenceSubject_, Use::Reference, k * perRound + j, {plan.reference})
                    .back());
    }

    double flipShare() const {
        return std::max(0.0, left(0.97 - (settings_.crops ? cropShare : 0)));
    }

    void renderCrops(TradeResult& result) {
        const double scale = full_.pixels() / size_.pixels();
        const double each = std::max(0.0, std::min(cropShare * settings_.budget, left(1))) /
                            static_cast<double>(subjects_.size());
        Pixels mean;
        for (const double v : result.referencePixels) mean.push_back(static_cast<float>(v));
        result.crops.push_back({"reference", std::move(mean)});
        for (std::size_t i = 0; i < subjects_.size(); ++i) {
            CandidateResult& c = result.candidates[i];
            tell("crop of " + c.candidate.name);
            const double perSample = c.secondsPerSample.value / scale;
            const int samples = std::clamp(static_cast<int>(each / perSample), 1, 100000);
            try {
                const Stage stage = render(subjects_[i], Use::Candidate, 0, {samples}).back();
                c.crop = result.crops.size();
                result.crops.push_back(
                    {fmt::format("{}, {}", c.candidate.name, formatDuration(each * scale)),
                     stage.pixels});
            } catch (const TimeIsUp&) {
                return;
            }
        }
    }

    const scene::SceneDescription& complete_;
    const ParseScene& parse_;
    const TradeSettings& settings_;
    const PictureSize full_;
    const Stopwatch watch_;
    scene::SceneDescription reference_;
    SceneStore store_;
    double referenceLoad_ = 0, meanRadiance_ = 0, secondsPerPixel_ = 0;
    std::optional<denoise::Denoiser> denoiser_;  // of the candidates that are denoised
    double denoiseSeconds_ = 0;                  // that it will take, of all pictures
    std::vector<ResolvedCandidate> resolved_;
    std::vector<Subject> subjects_;
    Subject referenceSubject_;
    PilotCost referenceCost_;
    PictureSize size_;
    TradeMeasurements measurements_;
    std::vector<std::string> notes_;
    std::string what_;
};

}  // namespace

std::optional<TradeResult> runTrade(const scene::SceneDescription& complete,
                                    const ParseScene& parse, const std::vector<Candidate>& given,
                                    const TradeSettings& settings) {
    try {
        return TradeRun(complete, parse, settings).run(given);
    } catch (const Interrupted&) {
        return std::nullopt;
    }
}

}  // namespace woodcock::trade
