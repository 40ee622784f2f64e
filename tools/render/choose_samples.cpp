// SPDX-License-Identifier: Apache-2.0
#include "tools/render/choose_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace woodcock::tool {

ChosenSamples chooseSamples(const render::RenderResult& trial) {
    constexpr double fewest = 4, most = 1024;
    const render::RenderCounters& c = trial.counters;
    const auto work = static_cast<double>(c.distanceSegments + c.distanceCollisions +
                                          c.shadowSegments + c.shadowCollisions);
    const double paths = std::max(1.0, static_cast<double>(c.paths));
    const double possible = work > 0 ? mostWork * paths / work : most;
    // The error falls with the square root of the samples.
    const double ofOne = trial.film.noise() * std::sqrt(trial.film.meanSamples());
    const double needed = std::isfinite(ofOne) ? std::pow(ofOne / goodNoise, 2) : most;
    const double samples = std::clamp(std::floor(std::min(possible, needed)), fewest, most);
    return {static_cast<int>(samples), ofOne / std::sqrt(samples), possible < needed};
}

std::string describe(const ChosenSamples& chosen) {
    const std::string noise = std::isfinite(chosen.noise)
                                  ? fmt::format("a noise of about {:.2g} %", 100 * chosen.noise)
                                  : std::string("an unknown noise");
    return chosen.limited ? fmt::format(
                                "chosen to take under a minute on two cores at 960 x 540, for {}; "
                                "--spp takes more",
                                noise)
                          : fmt::format("chosen for {}", noise);
}

}  // namespace woodcock::tool
