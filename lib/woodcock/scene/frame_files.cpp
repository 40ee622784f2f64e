// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/frame_files.h"

#include <algorithm>

#include "woodcock/base/error.h"
#include "woodcock/base/frame_names.h"
#include "woodcock/base/frame_range.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::scene {
namespace {

long long modulo(long long n, long long period) { return (n % period + period) % period; }

/// How many numbers a file is ahead of its frame.
long long aheadOf(const FileSequence& sequence) { return 1LL + sequence.offset - sequence.start; }

/// The number within [first, last] that stands for one outside; nothing: black.
std::optional<long long> wrapped(const FileSequence& sequence, long long number, int first,
                                 int last) {
    const long long n = number - first, length = last - first + 1LL;
    switch (sequence.outside) {
        case OutsideRule::Error:
            // Without the number, so that all such frames may be told of at once.
            throw inputError(
                "its files go from {} to {}, and frame n shows file n{}. outside = \"hold\", "
                "\"black\", \"repeat\" or \"ping_pong\" in its [[volume]] says what is shown "
                "elsewhere",
                first, last, aheadOf(sequence) == 0 ? "" : fmt::format(" {:+}", aheadOf(sequence)));
        case OutsideRule::Hold:
            return std::clamp<long long>(number, first, last);
        case OutsideRule::Black:
            return std::nullopt;
        case OutsideRule::Repeat:
            return first + modulo(n, length);
        case OutsideRule::PingPong:
            const long long there = modulo(n, std::max(1LL, 2 * length - 2));
            return first + std::min(there, 2 * length - 2 - there);
    }
    return std::nullopt;
}

std::string placeOfFile(const SceneDescription& scene, size_t index) {
    return findPlace(scene.places,
                     fmt::format("volume[{}].{}", index,
                                 keyName(scene.volumes[index], scene.volumes[index].file)));
}

bool isPattern(const std::filesystem::path& file) { return namesFrame(file.string()); }

/// Fills in all names but those of volumes.
void fillOthers(SceneDescription& scene, int frame) {
    for (std::filesystem::path* file : sceneFiles(scene)) {
        const bool ofVolume = std::any_of(scene.volumes.begin(), scene.volumes.end(),
                                          [&](const auto& volume) { return &volume.file == file; });
        if (!ofVolume) *file = withFrame(file->string(), frame);
    }
    OutputDescription& output = scene.output;
    for (std::filesystem::path& file : output.files) file = withFrame(file.string(), frame);
    for (std::filesystem::path* file : {&output.mattesFile, &output.deep})
        *file = withFrame(file->string(), frame);
}

}  // namespace

std::optional<int> sequenceFile(const FileSequence& sequence, int frame,
                                std::span<const int> onDisk) {
    const int first = onDisk.front(), last = onDisk.back();
    std::optional<long long> number = frame + aheadOf(sequence);
    if (*number < first || *number > last) number = wrapped(sequence, *number, first, last);
    if (!number) return std::nullopt;
    const auto after = std::upper_bound(onDisk.begin(), onDisk.end(), *number);
    const int before = *(after - 1);  // the first file, if no other
    if (before == *number) return before;
    switch (sequence.missing) {
        case MissingRule::Error:
            throw inputError(
                "file {} is missing between {} and {}. missing = \"hold\" or \"black\" in its "
                "[[volume]] says what is shown there",
                *number, before, *after);
        case MissingRule::Hold:
            return before;
        case MissingRule::Black:
            break;
    }
    return std::nullopt;
}

bool readsFrames(const SceneDescription& scene) {
    SceneDescription copy = scene;
    const std::vector<std::filesystem::path*> files = sceneFiles(copy);
    return std::any_of(files.begin(), files.end(),
                       [](const auto* file) { return isPattern(*file); });
}

const std::vector<int>& FrameFiles::onDisk(const std::string& pattern) {
    const auto [found, isNew] = onDisk_.try_emplace(pattern);
    if (isNew) found->second = framesOnDisk(pattern);
    if (found->second.empty())
        throw inputError("there is no file '{}' with a frame's number in place of '{}'", pattern,
                         framePattern(pattern));
    return found->second;
}

SceneDescription FrameFiles::at(const SceneDescription& scene, int frame) {
    SceneDescription filled = scene;
    for (size_t i = 0; i < filled.volumes.size(); ++i) {
        VolumeDescription& volume = filled.volumes[i];
        const std::string pattern = volume.file.string();
        if (!namesFrame(pattern)) continue;
        const std::optional<int> number = inPlace(placeOfFile(scene, i), [&] {
            const std::vector<int>& numbers = onDisk(pattern);
            return inPlace(pattern, [&] { return sequenceFile(volume.sequence, frame, numbers); });
        });
        volume.black = !number;
        if (number) volume.file = withFrame(pattern, *number);
        volume.sequence = {};
    }
    fillOthers(filled, frame);
    return filled;
}

SceneDescription FrameFiles::atLargest(const SceneDescription& scene, int frame) {
    SceneDescription filled = scene;
    for (size_t i = 0; i < filled.volumes.size(); ++i) {
        VolumeDescription& volume = filled.volumes[i];
        const std::string pattern = volume.file.string();
        if (!namesFrame(pattern)) continue;
        volume.sequence = {};
        std::uintmax_t most = 0;
        for (const int number : inPlace(placeOfFile(scene, i), [&] { return onDisk(pattern); })) {
            std::error_code none;
            const std::filesystem::path file = withFrame(pattern, number);
            const std::uintmax_t size = std::filesystem::file_size(file, none);
            if (volume.file == pattern || (!none && size > most)) volume.file = file, most = size;
        }
    }
    fillOthers(filled, frame);
    return filled;
}

}  // namespace woodcock::scene
