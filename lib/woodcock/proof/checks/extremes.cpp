// SPDX-License-Identifier: Apache-2.0
// Extreme numbers: results must be finite and right, and come without a hang.
#include "woodcock/proof/checks/extremes.h"

#include <fmt/format.h>

#include <cmath>

#include "woodcock/base/random.h"
#include "woodcock/medium/optical_depth.h"

namespace woodcock::proof {

Precision extremePrecision(const Lab& lab) {
    return lab.full() ? Precision{3e-3, 1e-5} : Precision{1e-2, 1e-4};
}

std::string digits(double value) { return fmt::format("{:.17g}", value); }

RgbEstimate watch(Lab& lab, const std::string& name, const render::Scene& scene,
                  const Precision& precision, const Watch& how) {
    // With few pixels the pilot's variance is a rough guess.
    const double margin = how.side < 32 ? 4 : 2;
    constexpr double mostSamples = 1 << 20;
    constexpr int mostRounds = 4;
    Picture picture{how.side, how.side, std::max(4, 512 / (how.side * how.side)), 0,
                    how.maxScatterings};
    std::optional<render::RenderResult> result;
    // A film that is too noisy tells how many samples are needed, and is discarded, as the pilot
    // is.
    for (int round = 0; round <= mostRounds; ++round) {
        picture.seed = hashOf(lab.seed(name), round);
        result.emplace(renderScene(scene, picture));
        const RgbEstimate found = evenRadiance(result->film);
        double ratio = 0;
        for (const int c : how.channels) {
            const Estimate& e = found[static_cast<std::size_t>(c)];
            ratio = std::max(ratio, e.error / precision.of(e.mean));
        }
        if (round > 0 && ratio <= 0.95) break;
        picture.samples =
            static_cast<int>(std::clamp(margin * picture.samples * ratio * ratio,
                                        round > 0 ? 1.0 * picture.samples : 4.0, mostSamples));
    }
    const render::RenderCounters& n = result->counters;
    const auto steps = static_cast<double>(n.distanceSegments + n.distanceCollisions +
                                           n.shadowSegments + n.shadowCollisions);
    lab.add({.name = "steps per flight, " + name,
             .expected = 0,
             .measured = steps / static_cast<double>(n.paths + n.scatterings + n.shadowRays),
             .allowance = how.mostSteps,
             .note = fmt::format("at most {}", how.mostSteps)});
    return evenRadiance(result->film);
}

double KnownGrid::opticalDepth(Vec3d origin, Vec3d direction) const {
    return sigma * length(worldFromIndex.vector(direction)) *
           oracle::lineIntegral(voxel, box, origin, direction, 0,
                                std::numeric_limits<double>::infinity());
}

void addTransmittance(Lab& lab, const std::string& name, const std::string& volume,
                      const KnownGrid& grid, Vec3d origin, Vec3d direction) {
    const double depth = grid.opticalDepth(origin, direction);
    const Vec3d eye = grid.worldFromIndex.point(origin);
    const Vec3d along = normalize(grid.worldFromIndex.vector(direction));
    const render::Scene scene = sceneIn(lab, volume + evenLight + pencilCamera(eye, along));
    const Precision precision = extremePrecision(lab);
    Case c = caseOf("transmittance, " + name, std::exp(-depth),
                    watch(lab, name, scene, precision)[0], precision);
    c.allowance += 1e-6 * depth * c.expected;
    lab.add(c);
    const double infinity = std::numeric_limits<double>::infinity();
    lab.add(
        {.name = "optical depth, " + name,
         .expected = depth,
         .measured = double{medium::exactOpticalDepth(scene.medium, eye, along, 0, infinity)[0]},
         .allowance = 2e-6 * depth,
         .note = "the exact integrator"});
}

std::vector<Check> extremes() {
    std::vector<Check> all;
    for (const auto& part : {extremeDepths(), extremeGrids(), extremeRays(), extremeContrasts()})
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

}  // namespace woodcock::proof
