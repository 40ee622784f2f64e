// SPDX-License-Identifier: Apache-2.0
#include "tools/render/checkpoint.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <system_error>

#include "tools/common/interrupt.h"
#include "tools/render/frame_reader.h"
#include "woodcock/base/error.h"
#include "woodcock/base/parse.h"
#include "woodcock/base/printable.h"
#include "woodcock/base/version.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/image/image_format.h"
#include "woodcock/render/saved_state.h"

namespace woodcock::tool {

namespace fs = std::filesystem;

fs::path checkpointFile(const scene::OutputDescription& output) {
    const std::vector<fs::path> outputs = output.files.empty() ? imagesOf(output) : output.files;
    if (outputs.empty()) return {};
    const auto exr = std::find_if(outputs.begin(), outputs.end(), [](const fs::path& file) {
        return image::imageFormat(file) == image::ImageFormat::Exr;
    });
    fs::path file = exr == outputs.end() ? outputs.front() : *exr;
    std::error_code ignored;
    const fs::file_status status = fs::status(file, ignored);
    if (fs::exists(status) && !fs::is_regular_file(status)) return {};
    return file.replace_extension(".checkpoint.exr");
}

Checkpoint::Checkpoint(const RenderOptions& options, const render::RenderSettings& settings,
                       image::Film::Window picture, const image::Outputs& outputs, fs::path file,
                       image::StateFacts facts,
                       std::function<image::RenderMetadata(const render::RenderState&)> metadata)
    : options_(options),
      settings_(settings),
      picture_(picture),
      outputs_(outputs),
      file_(std::move(file)),
      facts_(std::move(facts)),
      metadata_(std::move(metadata)) {}

std::optional<render::RenderState> Checkpoint::read() const {
    if (!fs::exists(file_)) {
        if (options_.resume) spdlog::info("there is no {}: the render begins anew", file_.string());
        return {};
    }
    if (!options_.resume) {
        if (options_.checkpoint)
            spdlog::warn("{} is of a render that was not finished; --resume would go on from it",
                         file_.string());
        return {};
    }
    const image::StateFile file(file_, "checkpoint");
    render::checkGoesOn(file, settings_, picture_, facts_);
    if (const std::string& program = file.fact("program"); program != version())
        spdlog::warn(
            "{} was written by woodcock {}, and this is {}: its samples may differ, so the picture "
            "may not have the bits of either",
            file_.string(), shown(program), version());
    render::RenderState state = render::readState(file);
    spdlog::info("goes on from {}: {} samples of each pixel, {}", file_.string(),
                 state.endSample - settings_.firstSample, formatDuration(state.seconds));
    return state;
}

render::Checkpoints Checkpoint::hooks() {
    if (file_.empty()) return {};
    render::Checkpoints hooks{.from = read()};
    last_ = std::chrono::steady_clock::now();
    hooks.wanted = [this] { return isDue(); };
    hooks.planned = options_.keepsCheckpoint();
    hooks.write = [this](const render::RenderState& state) { write(state); };
    return hooks;
}

bool Checkpoint::isDue() {
    const bool asked = takeCheckpointRequest();
    const std::chrono::duration<double> since = std::chrono::steady_clock::now() - last_;
    return asked || (options_.checkpoint && since.count() >= *options_.checkpoint);
}

bool Checkpoint::write(const render::RenderState& state) {
    const render::SavedState saved(state, settings_, picture_, render::Ending::Unfinished, facts_);
    bool done = false;
    try {
        outputs_.writeCheckpoint(file_, state.film, metadata_(state), saved.filmState(),
                                 state.mattes ? &*state.mattes : nullptr);
        done = written_ = true;
        spdlog::info("wrote {}: {} samples of each pixel", file_.string(),
                     state.endSample - settings_.firstSample);
    } catch (const Error& e) {
        spdlog::warn("no checkpoint: {}", e.what());
    }
    last_ = std::chrono::steady_clock::now();
    return done;
}

void Checkpoint::keep(const render::RenderResult& result) {
    if (file_.empty() || !active() || result.film.mostSamples() == 0) return;
    if (write(result)) spdlog::info("--resume goes on from it");
}

void Checkpoint::remove() const {
    if (file_.empty() || !active()) return;
    std::error_code error;
    fs::remove(file_, error);
    if (error) spdlog::warn("cannot remove {}: {}", file_.string(), error.message());
}

}  // namespace woodcock::tool
