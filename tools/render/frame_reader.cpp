// SPDX-License-Identifier: Apache-2.0
#include "tools/render/frame_reader.h"

#include <algorithm>
#include <chrono>
#include <set>

#include "tools/common/frames.h"
#include "tools/render/choices_text.h"
#include "woodcock/base/error.h"
#include "woodcock/base/memory.h"

namespace woodcock::tool {

double bytesOf(const scene::LoadedScene& scene) {
    std::set<const grid::Field*> fields;
    for (const scene::LoadedVolume& volume : scene.volumes)
        for (const scene::LoadedField* loaded : {&volume.density, &volume.albedo, &volume.emission,
                                                 &volume.blackbody, &volume.sigmaA, &volume.sigmaS})
            if (loaded->field) fields.insert(loaded->field.get());
    double bytes = 0;
    for (const grid::Field* field : fields) bytes += static_cast<double>(field->bytes());
    return bytes;
}

LoadedFrame FrameReader::read(int frame) {
    const auto start = std::chrono::steady_clock::now();
    LoadedFrame read;
    read.description = at(frame);
    read.loaded = load(read.description);
    if (!complete_) {
        scene::completeScene(read.description, read.loaded, look_);
        loadChosen(read.description, read.loaded);
    }
    read.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return read;
}

void FrameReader::readAhead(int frame, const scene::LoadedScene& present) {
    // A frame may be larger than the one before it, and reading takes more than what is read.
    constexpr double room = 2, atLeast = 64 << 20;
    if (static_cast<double>(memoryLeft()) < room * bytesOf(present) + atLeast) return;
    ahead_ = frame;
    next_ = std::async(std::launch::async, [this, frame] { return read(frame); });
}

LoadedFrame FrameReader::take(int frame) {
    if (!next_.valid()) return read(frame);
    std::future<LoadedFrame> next = std::move(next_);
    if (ahead_ == frame) return next.get();
    next.wait();
    return read(frame);
}

std::vector<int> FramePlan::failed() const {
    std::vector<int> frames;
    for (const auto& [error, numbers] : without)
        frames.insert(frames.end(), numbers.begin(), numbers.end());
    return frames;
}

std::vector<std::filesystem::path> imagesOf(const scene::OutputDescription& output) {
    std::vector<std::filesystem::path> files = output.files;
    for (const std::filesystem::path& file : {output.mattesFile, output.deep})
        if (!file.empty()) files.push_back(file);
    return files;
}

FramePlan planFrames(const std::vector<int>& frames, FrameReader& reader, bool skipExisting) {
    FramePlan plan;
    for (const int frame : frames) {
        try {
            const std::vector<std::filesystem::path> written = imagesOf(reader.at(frame).output);
            const bool skip = skipExisting && allExist(written);
            (skip ? plan.skipped : plan.drawn).push_back(frame);
        } catch (const Error& error) {
            const std::string why = error.what();
            auto known = std::find_if(plan.without.begin(), plan.without.end(),
                                      [&](const auto& each) { return each.first == why; });
            if (known == plan.without.end()) known = plan.without.insert(known, {why, {}});
            known->second.push_back(frame);
        }
    }
    return plan;
}

bool leavesChoices(const scene::SceneDescription& scene) {
    const Openings open = openingsOf(scene);
    for (std::size_t i = 0; i < scene.volumes.size(); ++i)
        if (open.scale[i] || scene::findPlace(scene.places, fmt::format("volume[{}]", i)).empty())
            return true;
    return open.camera || open.lights || scene.camera.orbit ||
           (scene.camera.kind == scene::CameraDescription::Kind::Orthographic &&
            !scene.camera.height);
}

}  // namespace woodcock::tool
