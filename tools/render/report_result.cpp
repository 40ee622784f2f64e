// SPDX-License-Identifier: Apache-2.0
#include "tools/render/report_result.h"

#include <spdlog/spdlog.h>

#include "tools/common/progress.h"
#include "tools/render/picture_warnings.h"
#include "woodcock/base/parse.h"
#include "woodcock/render/needs.h"

namespace woodcock::tool {

namespace {

std::string samplesText(const render::RenderResult& result,
                        const render::RenderSettings& settings) {
    if (!settings.adaptive)
        return fmt::format("samples {}:{} of each pixel", settings.firstSample, result.endSample);
    const image::Film& film = result.film;
    return fmt::format("the work of {} samples per pixel, {} to {} of them, {:.3g} in the mean",
                       result.endSample, film.fewestSamples(), film.mostSamples(),
                       film.meanSamples());
}

}  // namespace

void reportResult(const render::RenderResult& result, const render::RenderSettings& settings) {
    spdlog::info("{} in {}: {}, {}", stopReasonName(result.reason), formatDuration(result.seconds),
                 samplesText(result, settings), noiseOf(result));
    if (const std::uint64_t count = result.counters.clamped)
        spdlog::info("{} of {} paths were clamped to a radiance of {:g}", count,
                     result.counters.paths, settings.approximations.clamp);
    if (const std::uint64_t count = result.film.nonFiniteCount())
        spdlog::warn("{} samples were not finite and are left out", count);
    if (result.deep)
        spdlog::info("deep pixels: {:.3g} bins of depth in the mean pixel",
                     result.deep->meanBins());
    const std::uint64_t missing = result.film.pixelsWithoutSamples();
    if (missing > 0 && result.film.mostSamples() > 0)
        spdlog::warn("{} of {} pixels have no sample yet; they are black, with alpha 0{}", missing,
                     std::int64_t{result.film.crop().width()} * result.film.crop().height(),
                     result.reason == render::StopReason::TimeLimit
                         ? ": one sample of each takes longer than twice the time limit"
                         : "");
}

void reportNeeds(const render::Scene& scene) {
    const render::Needs needs = render::findNeeds(scene);
    spdlog::info("the scene {}", render::usedOf(needs));
    if (const std::string unused = render::unusedOf(needs); !unused.empty())
        spdlog::debug("the scene {}", unused);
}

}  // namespace woodcock::tool
