// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/measure.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "woodcock/render/session.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/load.h"
#include "woodcock/trade/timing.h"

namespace woodcock::trade {
namespace {

/// The settings that decide what is loaded and built. With levels of detail the size of the picture
/// matters.
scene::SceneDescription loadKey(scene::SceneDescription scene) {
    const scene::RenderDescription render = scene.render;
    scene.places.clear();
    scene.output = {};
    scene.render = {};
    scene.render.storage = render.storage;
    scene.render.lookup = render.lookup;
    scene.render.majorantScale = render.majorantScale;
    if (render.levelOfDetail > 0) {
        scene.render.levelOfDetail = render.levelOfDetail;
        scene.render.width = render.width, scene.render.height = render.height;
    }
    return scene;
}

std::size_t bytesOf(const render::Scene& scene) {
    std::set<const grid::Field*> fields;  // parts may share one
    std::size_t bytes = 0;
    const auto add = [&](const medium::Medium& medium) {
        for (const medium::MediumPart& part : medium.parts) {
            bytes += part.majorants().bytes();
            for (const grid::Field* field : {part.field(), part.albedo()})
                if (field && fields.insert(field).second) bytes += field->bytes();
        }
    };
    add(scene.medium);
    for (const medium::Medium& medium : scene.interiorMedia) add(medium);
    return bytes;
}

Pixels pixelsOf(const image::Film& film) {
    Pixels pixels;
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) {
            const Rgb radiance = film.radiance(x, y);
            for (int c = 0; c < 3; ++c) pixels.push_back(radiance[c]);
        }
    return pixels;
}

}  // namespace

std::shared_ptr<const render::Preparation> BuiltScene::preparation(
    PictureSize size, const render::Approximations& approximations) const {
    for (const auto& p : prepared)
        if (p->fits(scene, size.width, size.height, approximations)) return p;
    return prepared.emplace_back(std::make_shared<const render::Preparation>(
        scene, size.width, size.height, approximations));
}

bool SceneStore::has(const scene::SceneDescription& scene) const {
    const scene::SceneDescription key = loadKey(scene);
    return std::any_of(entries_.begin(), entries_.end(),
                       [&](const Entry& entry) { return entry.key == key; });
}

const BuiltScene& SceneStore::get(const scene::SceneDescription& scene) {
    const scene::SceneDescription key = loadKey(scene);
    for (const Entry& entry : entries_)
        if (entry.key == key) return entry.built;
    const Stopwatch watch;
    render::Scene built = scene::buildScene(scene, scene::loadScene(scene));
    const double seconds = watch.seconds();
    const std::size_t bytes = bytesOf(built);
    entries_.push_back({key, {std::move(built), seconds, bytes}});
    return entries_.back().built;
}

std::optional<std::vector<Stage>> renderStages(const Subject& subject, std::uint64_t seed,
                                               const std::vector<int>& samples, int threads,
                                               const GoOn& goOn) {
    render::RenderSettings settings = scene::renderSettings(subject.render);
    settings.seed = seed;
    settings.threads = threads;
    settings.timeLimit = settings.noise = 0;
    settings.layers.features = subject.denoiser.has_value();
    std::vector<Stage> stages;
    std::optional<image::Film> film;
    double seconds = 0, cpuSeconds = 0;
    int done = 0;
    for (const int count : samples) {
        // Adaptive samples depend on those before them, so such a picture is rendered in one go.
        const bool atOnce = settings.adaptive;
        if (atOnce) film.reset(), seconds = cpuSeconds = 0;
        settings.firstSample = atOnce ? 0 : done;
        settings.endSample = count;
        const double cpuStart = processorSeconds();
        const Stopwatch watch;
        render::RenderResult result =
            render::renderPrepared(*subject.scene, settings, subject.prepared,
                                   [&](const render::RenderProgress&) { return goOn(); });
        seconds += watch.seconds();
        cpuSeconds += processorSeconds() - cpuStart;
        if (result.reason == render::StopReason::Interrupted) return std::nullopt;
        if (film)
            film->merge(result.film);
        else
            film = std::move(result.film);
        done = count;
        stages.push_back({count, {}, seconds, cpuSeconds, film->noise()});
        if (subject.denoiser) {
            image::DenoisedPicture denoised = subject.denoiser->denoise(*film, threads);
            stages.back().pixels = std::move(denoised.colour);
            stages.back().denoiseSeconds = denoised.seconds;
        } else {
            stages.back().pixels = pixelsOf(*film);
        }
    }
    return stages;
}

std::vector<int> stageCounts(int samples) {
    std::vector<int> counts;
    for (const int divisor : {16, 4, 1})
        if (samples / divisor > (counts.empty() ? 0 : counts.back()))
            counts.push_back(samples / divisor);
    return counts;
}

}  // namespace woodcock::trade
