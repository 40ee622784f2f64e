// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <set>

#include "tools/common/command.h"
#include "tools/common/exit_codes.h"
#include "tools/common/frames.h"
#include "tools/common/interrupt.h"
#include "tools/common/json_text.h"
#include "tools/common/output_folders.h"
#include "tools/common/picture_facts.h"
#include "tools/common/print.h"
#include "tools/common/progress.h"
#include "tools/common/scene_input.h"
#include "tools/common/stats.h"
#include "tools/render/checkpoint.h"
#include "tools/render/choices_text.h"
#include "tools/render/choose_exposure.h"
#include "tools/render/choose_samples.h"
#include "tools/render/estimate.h"
#include "tools/render/frame_reader.h"
#include "tools/render/options.h"
#include "tools/render/picture_warnings.h"
#include "tools/render/prepare.h"
#include "tools/render/quality_auto.h"
#include "tools/render/report_result.h"
#include "tools/render/trial.h"
#include "woodcock/base/error.h"
#include "woodcock/base/frame_names.h"
#include "woodcock/base/frame_range.h"
#include "woodcock/base/memory.h"
#include "woodcock/base/toml_text.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/image/image_format.h"
#include "woodcock/image/outputs.h"
#include "woodcock/render/camera_depths.h"
#include "woodcock/render/light_depths.h"
#include "woodcock/render/precision.h"
#include "woodcock/render/saved_state.h"
#include "woodcock/render/session.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/light_groups.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::tool {

namespace {

void writeTextFile(const std::filesystem::path& file, const std::string& text) {
    if (isStdout(file))
        printData(text);
    else
        writeWholeFile(file, text);
}

void warnUnlessEmpty(const std::string& text) {
    if (!text.empty()) spdlog::warn("{}", text);
}

bool haveSameFields(const scene::SceneDescription& a, const scene::SceneDescription& b) {
    const scene::RenderDescription &ra = a.render, &rb = b.render;
    return a.volumes == b.volumes && ra.storage == rb.storage && ra.lookup == rb.lookup &&
           ra.levelOfDetail == rb.levelOfDetail;
}

/// One call of the command, in its phases: check, load, build, render, write; the last four for
/// each frame of a sequence.
class RenderJob {
public:
    RenderJob(const RenderOptions& options, const std::string& commandLine)
        : options_(options), commandLine_(commandLine), style_(options.reports.start()) {}

    void run() {
        options_.check();
        description_ = describeScene(
            options_, hasSceneFiles() ? std::optional(frameWithScene()) : std::nullopt);
        catchCheckpointRequests();
        catchInterrupts();  // not while a scene that comes through a pipe is waited for
        checkWhatIsAsked();
        askedDenoising_ = description_.render.denoise;
        settleDenoising();
        settings_ = renderSettings(description_, options_);
        if (options_.rendersImages()) tellMatteNames();
        if (isSequence())
            renderFrames();
        else
            renderOne();
    }

private:
    using Clock = std::chrono::steady_clock;
    using Json = nlohmann::ordered_json;

    std::vector<std::filesystem::path> files() const { return imagesOf(description_.output); }

    /// Or a scene is saved that stands for one.
    bool isSequence() const {
        return !options_.frames.empty() ||
               (options_.takesFrames() && scene::readsFrames(description_));
    }

    /// Each frame has a scene file of its own.
    bool hasSceneFiles() const {
        const std::filesystem::path& input = options_.inputs.front();
        return !options_.frames.empty() && isSceneFile(input) && namesFrame(input.string());
    }

    /// The first that has one, or else the first.
    int frameWithScene() const {
        const auto found =
            std::find_if(options_.frames.begin(), options_.frames.end(), [&](int frame) {
                return std::filesystem::exists(inFrame(options_.inputs.front(), frame));
            });
        return found == options_.frames.end() ? options_.frames.front() : *found;
    }

    void checkWhatIsAsked() const {
        if (files().empty() && options_.rendersImages() && !options_.estimate)
            throw usageError("there is no output; name a file with -o, such as -o smoke.exr");
        if (options_.rendersImages()) {
            const scene::OutputDescription& output = description_.output;
            options_.checkFor(output.files);
            checkCompositing(description_, options_);
            for (std::size_t i = 0; i < output.files.size(); ++i)
                checkFrameOutput(
                    output.files[i],
                    scene::findPlace(description_.places, fmt::format("output.files[{}]", i)),
                    options_.frames);
            for (const std::filesystem::path* file : {&output.mattesFile, &output.deep})
                if (!file->empty())
                    checkFrameOutput(*file, placeOfLayerFile(description_, *file), options_.frames);
        }
        if (!isSequence()) checkFiles(description_, options_);
        if (hasSceneFiles() && options_.choosesQuality())
            throw usageError(
                "--quality auto chooses for one scene, and each frame has a scene file of its own");
    }

    image::Outputs preparedOutputs() const {
        image::Outputs outputs = prepareOutputs(description_, options_);
        if (!outputs.note().empty()) spdlog::warn("{}", outputs.note());
        return outputs;
    }

    void renderOne() {
        if (options_.skipExisting && options_.rendersImages() && allExist(files())) {
            spdlog::info("{} is there already: nothing to do", files().front().string());
            return;
        }
        image::Outputs outputs = preparedOutputs();
        loadStart_ = Clock::now();
        if (load()) outputs = prepareOutputs(description_, options_);
        if (options_.estimate) return estimate(outputs);
        if (!options_.rendersImages()) return;
        if (options_.choosesQuality()) chooseSettings();
        if (render(outputs)) endWith(exitInterrupted);
    }

    /// Returns whether an exposure was chosen.
    bool load() {
        const Openings open = openingsOf(description_);
        const std::filesystem::path frame =
            options_.plain ? std::filesystem::path() : frameToChooseFrom(description_);
        loaded_ = loadAndComplete(description_, options_.choicesLook());
        checkFiles(description_, options_);  // with what --set says of lights that were chosen
        const bool exposes = choosesExposure(open);
        const bool counts = options_.leavesSamplesOpen(description_);
        if (exposes || counts) {
            const bool other = !frame.empty() && frame != description_.volumes[0].file;
            scene::SceneDescription scene = description_;
            if (other) scene.volumes[0].file = frame;
            chooseByTrial(scene, other ? scene::loadScene(scene) : loaded_, exposes, counts);
        }
        saveScene(open);
        return exposes;
    }

    bool choosesExposure(const Openings& open) const {
        return open.exposure && open.lights && !description_.lights.empty() && !options_.plain &&
               writesPictureOrScene();
    }

    bool writesPictureOrScene() const {
        return !options_.writeScene.empty() ||
               std::any_of(description_.output.files.begin(), description_.output.files.end(),
                           [](const auto& file) {
                               return image::imageFormat(file) != image::ImageFormat::Exr;
                           });
    }

    /// What a small render tells: of a complete scene, which may be another frame of this one.
    void chooseByTrial(const scene::SceneDescription& scene, scene::LoadedScene loaded,
                       bool exposes, bool counts) {
        const render::RenderResult trial =
            renderTrial(scene::buildScene(scene, std::move(loaded)), settings_);
        if (exposes) {
            const scene::OutputDescription& output = scene.output;
            description_.output.exposure = chooseExposure(
                trial.film, image::ColorConfig(scene.ocio)
                                .displayTransform({output.display, output.view, output.look, 0}));
            spdlog::info(
                "chosen, so that its bright parts are near white:\n[output]\nexposure = {}",
                tomlNumber(description_.output.exposure));
        }
        if (!counts) return;
        const ChosenSamples chosen = chooseSamples(trial);
        description_.render.spp = settings_.endSample = chosen.perPixel;
        spdlog::info("{}:\n[render]\nspp = {}", describe(chosen), chosen.perPixel);
    }

    void saveScene(const Openings& open) const {
        const std::filesystem::path& file = options_.writeScene;
        if (file.empty()) return;
        scene::SceneDescription saved = description_;
        saved.render.denoise = askedDenoising_;
        writeTextFile(file, scene::writeScene(saved, file.parent_path()));
        if (!isStdout(file))
            spdlog::info("wrote {}: {}", file.string(), describeChoices(open, description_));
    }

    /// Finds the denoiser, and tells of it in the first frame alone.
    void settleDenoising() {
        scene::SceneDescription noisy = description_;
        noisy.render.denoise = scene::Denoise::Never;
        std::vector<std::string> notes;
        if (options_.rendersImages()) {
            denoiser_ = denoiserOf(description_, options_, &notes);
            if (denoiser_ &&
                scene::outputLayers(description_).size() < scene::outputLayers(noisy).size())
                notes.push_back(
                    "layers of noise are left out: they would describe the picture before it is "
                    "denoised");
        }
        for (const std::string& note : notes)
            if (told_.insert(note).second) spdlog::info("{}", note);
    }

    /// Names that the scene leaves open.
    void tellMatteNames() const {
        std::vector<std::string> notes;
        mattesOf(description_, &notes);
        std::sort(notes.begin(), notes.end());
        notes.erase(std::unique(notes.begin(), notes.end()), notes.end());
        if (!notes.empty()) spdlog::info("chosen, for mattes:\n{}", fmt::join(notes, "\n"));
    }

    /// For --quality auto.
    void chooseSettings() {
        const scene::SceneDescription before = description_;
        if (!chooseQuality(description_, options_, commandLine_)) endWith(exitInterrupted);
        if (!haveSameFields(before, description_)) loaded_ = scene::loadScene(description_);
        settleDenoising();
        settings_ = renderSettings(description_, options_);
    }

    // ---- a sequence; description_ and loaded_ are those of a frame while it is drawn

    void renderFrames() {
        reader_.emplace(description_, options_.choicesLook());
        if (hasSceneFiles())
            reader_.emplace(description_, options_.choicesLook(),
                            [this](int frame) { return describeScene(options_, frame); });
        if (!hasSceneFiles() && !changesWithFrame(description_))
            spdlog::warn(
                "nothing in the scene changes with the frame: all pictures will be the same");
        plan_ = planFrames(options_.frames, *reader_, options_.skipExisting);
        const std::size_t missing = plan_.failed().size();
        if (missing > 0 && missing == options_.frames.size())
            throw inputError("frame {}: {}", plan_.without.front().second.front(),
                             plan_.without.front().first);
        for (const auto& [error, frames] : plan_.without)
            spdlog::error("{}: {}", framesText(frames), error);
        if (!plan_.skipped.empty()) spdlog::info("{}: there already", framesText(plan_.skipped));
        if (!plan_.drawn.empty() || !options_.rendersImages()) chooseForAll();
        if (options_.estimate && !plan_.drawn.empty())
            estimate(prepareOutputs(reader_->at(plan_.drawn.front()), options_));
        else if (options_.rendersImages() && !options_.estimate)
            drawFrames();
    }

    static std::string framesText(const std::vector<int>& frames) {
        return fmt::format("frame{} {}", frames.size() == 1 ? "" : "s", frameRangeText(frames));
    }

    static bool changesWithFrame(const scene::SceneDescription& scene) {
        return scene::readsFrames(scene) || !scene.animation.empty();
    }

    /// Chooses what is open, alike for all frames: from the largest file of each sequence.
    void chooseForAll() {
        const int frame = plan_.drawn.empty() ? 0 : plan_.drawn.front();
        scene::SceneDescription& sequence = reader_->sequence();
        description_ = reader_->atLargest(frame);
        checkFiles(description_, options_);
        preparedOutputs();  // what is wrong with them is wrong for all
        const Openings open = openingsOf(sequence);
        if (leavesChoices(sequence) && !hasSceneFiles()) {
            scene::LoadedScene loaded = reader_->load(description_);
            tellOnce(spdlog::level::warn, loaded.notes);
            for (std::size_t i = 0; i < sequence.volumes.size(); ++i)
                if (description_.volumes[i].file != sequence.volumes[i].file)
                    spdlog::info(
                        "what follows is chosen from the largest file of {}, {}, and is the same "
                        "for every frame",
                        sequence.volumes[i].file.string(), description_.volumes[i].file.string());
            for (const std::string& choice :
                 scene::completeScene(sequence, loaded, options_.choicesLook()))
                spdlog::info("{}", choice);
            reader_->setComplete();
            description_ = reader_->atLargest(frame);
            const bool exposes = choosesExposure(open);
            const bool counts = options_.leavesSamplesOpen(description_);
            if (exposes || counts) {
                reader_->loadChosen(description_, loaded);
                chooseByTrial(description_, std::move(loaded), exposes, counts);
                sequence.output.exposure = description_.output.exposure;
                sequence.render.spp = description_.render.spp;
            }
        }
        description_ = sequence;
        saveScene(open);
    }

    void drawFrames() {
        place_ = FramePlace{0, 0, plan_.drawn.size(), Clock::now()};
        FrameReport report = forEachFrame(plan_.drawn, [&](int frame) { return drawFrame(frame); });
        const std::vector<int> missing = plan_.failed();
        report.failed.insert(report.failed.end(), missing.begin(), missing.end());
        std::sort(report.failed.begin(), report.failed.end());
        if (!hasOwnStats()) {
            const Json all{
                {"frames", stats_}, {"failed", report.failed}, {"skipped", plan_.skipped}};
            writeStats(options_.stats, all);
            if (options_.reports.json) writeStats("-", all);
        }
        endUnlessDone(report);
    }

    ExitCode drawFrame(int frame) {
        const std::vector<int>& frames = plan_.drawn;
        const auto next = std::find(frames.begin(), frames.end(), frame) + 1;
        place_->frame = frame;
        place_->index = static_cast<std::size_t>(next - frames.begin()) - 1;
        LoadedFrame now = reader_->take(frame);
        loadStart_ = Clock::now() - std::chrono::duration_cast<Clock::duration>(
                                        std::chrono::duration<double>(now.seconds));
        description_ = std::move(now.description), loaded_ = std::move(now.loaded);
        if (hasSceneFiles()) {
            settleDenoising();
            settings_ = renderSettings(description_, options_);
        }
        if (options_.choosesQuality() && place_->index == 0) {
            chooseSettings();
            reader_->sequence().render = description_.render;
        }
        if (next != frames.end()) reader_->readAhead(*next, loaded_);
        spdlog::info("frame {}, {} of {}", frame, place_->index + 1, frames.size());
        tellOnce(spdlog::level::warn, loaded_.notes);
        tellOnce(spdlog::level::info, velocityNotes(description_, loaded_));
        checkFiles(description_, options_);
        return render(prepareOutputs(description_, options_)) ? exitInterrupted : exitDone;
    }

    /// Notes that differ in the frame's file alone are told in the first.
    void tellOnce(spdlog::level::level_enum level, const std::vector<std::string>& notes) {
        for (const std::string& note : notes) {
            std::string alike = note;
            const auto& patterns = reader_->sequence().volumes;
            for (std::size_t i = 0; i < std::min(description_.volumes.size(), patterns.size());
                 ++i) {
                const std::string file = description_.volumes[i].file.string();
                const std::string pattern = patterns[i].file.string();
                const std::size_t at = file.empty() ? alike.npos : alike.find(file);
                if (at != alike.npos) alike.replace(at, file.size(), pattern);
            }
            if (told_.insert(alike).second) spdlog::log(level, "{}", note);
        }
    }

    /// Each frame's counts go into a file of its own.
    bool hasOwnStats() const { return namesFrame(options_.stats.string()); }

    // ---- no picture

    /// Says what this would take.
    void estimate(const image::Outputs& outputs) {
        const double pixels = settings_.crop
                                  ? double(settings_.crop->width()) * settings_.crop->height()
                                  : double(settings_.width) * settings_.height;
        std::vector<FrameTrial> trials;
        constexpr std::size_t mostTrials = 5;
        std::uintmax_t largest = 0;
        for (const int frame : plan_.drawn)
            largest = std::max(largest, bytesOfVolumes(reader_->at(frame)));
        for (const int frame : spreadFrames(plan_.drawn, mostTrials)) {
            LoadedFrame loaded = reader_->take(frame);
            description_ = std::move(loaded.description), loaded_ = std::move(loaded.loaded);
            trials.push_back({.frame = frame, .loadSeconds = loaded.seconds});
            measure(trials.back());
        }
        if (trials.empty()) {
            trials.push_back({.loadSeconds = secondsSince(loadStart_)});
            measure(trials.back());
            largest = trials.back().fileBytes;
        }
        double scenes = 0;
        for (const FrameTrial& trial : trials) scenes = std::max(scenes, trial.sceneBytes);
        // The trials held the scenes that rendering holds, and next to no picture.
        const double fixed = std::max(0.0, static_cast<double>(peakMemoryBytes()) -
                                               (trials.size() > 1 ? 2 : 1) * scenes) +
                             pixels * (filmBytesPerPixel(settings_, description_) +
                                       writingBytesPerPixel(settings_, description_, outputs)) +
                             depthBytes_;
        const RenderEstimate estimate =
            estimateAll(std::move(trials), std::max<std::size_t>(1, plan_.drawn.size()), fixed,
                        largest, denoisingTime(pixels));
        if (options_.reports.json)
            printJson(estimateJson(estimate));
        else if (options_.reports.printsText())
            printText(estimateText(estimate));
    }

    void measure(FrameTrial& trial) {
        const auto start = Clock::now();
        trial.fileBytes = bytesOfVolumes(description_);
        trial.sceneBytes = bytesOf(loaded_);
        const render::Scene scene = scene::buildScene(description_, std::move(loaded_));
        depthBytes_ = std::max(depthBytes_, bytesOfDepths(scene));
        trial.loadSeconds += secondsSince(start);
        if (!measureRender(scene, settings_, trial, [] { return !interrupted(); }))
            endWith(exitInterrupted);
    }

    Guess denoisingTime(double pixels) const {
        if (!denoiser_) return {};
        return timeByPixels(
            [&](int side) {
                const image::Film blank(side, side, {0, 0, side, side}, {false, true, false});
                return denoiser_->denoise(blank, settings_.threads).seconds;
            },
            pixels);
    }

    static double secondsSince(Clock::time_point start) {
        return std::chrono::duration<double>(Clock::now() - start).count();
    }

    /// Memory that grids of optical depths take at most.
    double bytesOfDepths(const render::Scene& scene) const {
        return render::bytesOfLightDepths(scene, settings_.approximations) +
               render::bytesOfCameraDepths(scene, settings_.width, settings_.height);
    }

    static std::uintmax_t bytesOfVolumes(const scene::SceneDescription& scene) {
        std::uintmax_t bytes = 0;
        for (const scene::VolumeDescription& volume : scene.volumes) {
            std::error_code none;
            const std::uintmax_t size = std::filesystem::file_size(volume.file, none);
            if (!none) bytes += size;
        }
        return bytes;
    }

    // ---- a picture

    /// Returns whether it was interrupted. What was drawn by then is written, but not of a frame:
    /// it would pass for a finished one.
    bool render(const image::Outputs& outputs) {
        PictureWarnings warnings(description_, loaded_);
        std::vector<std::string> notes;
        const render::Scene scene = scene::buildScene(description_, std::move(loaded_), &notes);
        for (const std::string& note : notes) tellInFirst(note);
        const std::chrono::duration<double> loading = Clock::now() - loadStart_;
        if (interrupted()) return true;
        for (const std::string& warning : render::precisionWarnings(scene))
            spdlog::warn("{}", warning);
        warnUnlessEmpty(warnings.ofCamera(scene));
        for (const std::string& warning : warnings.ofMotion(scene)) spdlog::warn("{}", warning);

        checkMemoryLeft(settings_, description_, outputs, options_.keepsCheckpoint(),
                        bytesOfDepths(scene));
        if (!place_ || place_->index == 0) reportNeeds(scene);
        const image::StateFacts facts = factsOf(description_);
        const std::string& digest = facts.at("scene");
        Checkpoint checkpoint(
            options_, settings_, pictureOf(description_.render, options_), outputs,
            checkpointFile(description_.output), facts,
            [&](const render::RenderState& state) { return metadataOf(state, digest); });
        const render::RenderResult result =
            renderWithProgress(scene, settings_, style_, place_, checkpoint.hooks());
        const bool stopped = result.reason == render::StopReason::Interrupted;
        if (stopped) checkpoint.keep(result);
        if (stopped && place_) return true;
        reportResult(result, settings_);
        write(result, outputs, facts);
        if (!stopped) checkpoint.remove();
        if (result.film.mostSamples() > 0) warnUnlessEmpty(warnings.ofPicture(scene, result));
        keepStats(result, digest, loading.count());
        if (result.film.mostSamples() == 0 && !stopped)
            throw failure(
                "nothing was rendered within twice the time limit of {}: nothing is written. Paths "
                "may be without end: look for media of albedo 1 that fill all space, or give "
                "max_bounces or max_scatterings",
                formatDuration(settings_.timeLimit));
        return stopped;
    }

    void tellInFirst(const std::string& note) {
        if (!place_ || told_.insert(note).second) spdlog::info("{}", note);
    }

    image::RenderMetadata metadataOf(const render::RenderState& state,
                                     const std::string& digest) const {
        image::RenderMetadata metadata{settings_.firstSample, state.endSample, settings_.seed,
                                       state.seconds,         digest,          commandLine_,
                                       settings_.adaptive};
        scene::describeShot(description_, metadata);
        return metadata;
    }

    /// The picture denoised, where that is asked for. What went wrong is left in `flaw`: hours of
    /// samples are not lost by it.
    std::optional<image::DenoisedPicture> denoise(const render::RenderResult& result,
                                                  std::optional<Error>& flaw) const {
        if (!denoiser_) return {};
        try {
            image::DenoisedPicture picture = denoiser_->denoise(result.film, settings_.threads);
            spdlog::info("denoised in {} by {}", formatDuration(picture.seconds), picture.denoiser);
            return picture;
        } catch (const Error& e) {
            flaw = Error(e.kind(), fmt::format("{}. The picture is written as it was rendered, "
                                               "without being denoised",
                                               e.what()));
            return {};
        }
    }

    void write(const render::RenderResult& result, const image::Outputs& outputs,
               const image::StateFacts& facts) {
        denoiseSeconds_.reset();
        if (result.film.mostSamples() > 0) {
            std::optional<Error> flaw;
            const std::optional<image::DenoisedPicture> denoised = denoise(result, flaw);
            if (denoised) denoiseSeconds_ = denoised->seconds;
            std::optional<render::SavedState> sums;
            if (options_.keepsSums())
                sums.emplace(result, settings_, pictureOf(description_.render, options_),
                             render::endingOf(result.reason), facts);
            const std::string note = outputs.write(
                result.film, metadataOf(result, facts.at("scene")),
                {result.mattes ? &*result.mattes : nullptr, result.deep ? &*result.deep : nullptr,
                 denoised ? &*denoised : nullptr},
                sums ? &sums->filmState() : nullptr);
            for (const std::filesystem::path& file : files())
                spdlog::info("wrote {}", file.string());
            if (!note.empty()) spdlog::info("{}", note);
            if (flaw) throw *flaw;
        } else if (result.reason != render::StopReason::TimeLimit) {
            spdlog::warn("interrupted before anything was rendered: nothing is written");
        }
    }

    void keepStats(const render::RenderResult& result, const std::string& digest,
                   double loadSeconds) {
        Json stats = statsJson(
            result, settings_, digest, loadSeconds,
            result.film.mostSamples() > 0 ? files() : std::vector<std::filesystem::path>());
        if (denoiseSeconds_) {
            stats["denoiser"] = denoiser_->name();
            stats["denoise_seconds"] = *denoiseSeconds_;
        }
        if (!place_) {
            writeStats(options_.stats, stats);
            if (options_.reports.json) writeStats("-", stats);
            return;
        }
        Json ofFrame{{"frame", place_->frame}};
        ofFrame.update(stats);
        if (hasOwnStats()) {
            const std::filesystem::path file = inFrame(options_.stats, place_->frame);
            prepareOutput(file, options_.mkdir, "--stats");
            writeStats(file, ofFrame);
        }
        stats_.push_back(std::move(ofFrame));
    }

    static void writeStats(const std::filesystem::path& file, const Json& stats) {
        if (!file.empty()) writeTextFile(file, jsonText(stats, 4) + "\n");
    }

    const RenderOptions& options_;
    const std::string& commandLine_;
    ProgressStyle style_;
    scene::SceneDescription description_;
    scene::Denoise askedDenoising_ = scene::Denoise::Never;  // before the denoiser was looked for
    std::optional<denoise::Denoiser> denoiser_;
    double depthBytes_ = 0;  // of the trial that takes most, where time and memory are estimated
    std::optional<double> denoiseSeconds_;  // of the last picture
    render::RenderSettings settings_;
    scene::LoadedScene loaded_;
    Clock::time_point loadStart_;

    std::optional<FrameReader> reader_;  // of a sequence, as all that follows
    FramePlan plan_;
    std::optional<FramePlace> place_;
    std::vector<Json> stats_;
    std::set<std::string> told_;
};

CLI::App& addTo(CLI::App& app, const std::string& commandLine) {
    CLI::App& command = *app.add_subcommand("render", "Render a scene or a volume to images");
    const auto options = std::make_shared<RenderOptions>();
    options->addTo(command);
    command.callback([options, commandLine] { RenderJob(*options, commandLine).run(); });
    return command;
}

}  // namespace

extern const Command renderCommand{&addTo};

}  // namespace woodcock::tool
