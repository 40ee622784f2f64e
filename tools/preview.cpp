// SPDX-License-Identifier: Apache-2.0
#include "preview.h"

#include <spdlog/spdlog.h>

#include "interrupt.h"
#include "woodcock/image/outputs.h"
#include "woodcock/render/session.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/defaults.h"
#include "woodcock/scene/load.h"
#include "woodcock/scene/parse.h"
#include "woodcock/scene/write.h"

namespace woodcock::tool {

namespace {

Outputs previewOutputs(const std::filesystem::path& picture) {
    ColorConfig colour("");
    OutputSettings settings{.colour = std::move(colour)};
    settings.files = {picture};
    return Outputs(std::move(settings));
}

}  // namespace

void checkPreview(const std::filesystem::path& picture) { previewOutputs(picture); }

bool renderPreview(const std::filesystem::path& volume, const std::filesystem::path& picture,
                   ProgressStyle style) {
    const std::vector<std::filesystem::path> inputs{volume};
    SceneDescription description = parseSceneText(
        defaultSceneText(inputs), "preview", "", {"render.resolution=[480, 320]", "render.spp=64"});
    LoadedScene loaded = loadScene(description);
    for (const std::string& note : loaded.notes) spdlog::warn("{}", note);
    completeScene(description, loaded);
    const Scene scene = buildScene(description, std::move(loaded));

    const Outputs outputs = previewOutputs(picture);
    RenderSettings settings;
    settings.width = description.render.width, settings.height = description.render.height;
    settings.endSample = description.render.spp;
    settings.timeLimit = 20;
    Progress progress(style);
    progress.start(settings);
    const RenderResult result = render(scene, settings, [&](const RenderProgress& now) {
        progress.update(now);
        return !interrupted();
    });
    progress.finish(result);
    if (result.film.mostSamples() > 0) {
        outputs.write(result.film, {settings.firstSample, result.endSample, settings.seed,
                                    result.seconds, sceneDigest(description), ""});
        spdlog::info("wrote {}", picture.string());
    }
    return result.reason != StopReason::Interrupted;
}

}  // namespace woodcock::tool
